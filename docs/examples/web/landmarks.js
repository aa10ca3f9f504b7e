// A person's landmarks, as MediaPipe's pose landmarker finds them, as a skeleton that an avatar can follow.

import { Matrix4, Quaternion, Vector3 } from "three";

// Name, parent and place of each joint of a body at rest that faces +Z with its arms out, metres; of limbs, the landmarks at
// both ends of the bone (https://ai.google.dev/edge/mediapipe/solutions/vision/pose_landmarker).
const JOINTS = [
  ["Hips", -1, [0, 0.95, 0]],
  ["Spine", 0, [0, 1.1, 0]],
  ["Head", 1, [0, 1.55, 0]],
  ["LeftArm", 1, [0.18, 1.4, 0], 11, 13],
  ["LeftForeArm", 3, [0.46, 1.4, 0], 13, 15],
  ["LeftHand", 4, [0.7, 1.4, 0]],
  ["RightArm", 1, [-0.18, 1.4, 0], 12, 14],
  ["RightForeArm", 6, [-0.46, 1.4, 0], 14, 16],
  ["RightHand", 7, [-0.7, 1.4, 0]],
  ["LeftUpLeg", 0, [0.1, 0.92, 0], 23, 25],
  ["LeftLeg", 9, [0.1, 0.5, 0], 25, 27],
  ["LeftFoot", 10, [0.1, 0.08, 0], 27, 31],
  ["LeftToe", 11, [0.1, 0.02, 0.14]],
  ["RightUpLeg", 0, [-0.1, 0.92, 0], 24, 26],
  ["RightLeg", 13, [-0.1, 0.5, 0], 26, 28],
  ["RightFoot", 14, [-0.1, 0.08, 0], 28, 32],
  ["RightToe", 15, [-0.1, 0.02, 0.14]],
];
const LEG = 0.84; // metres from hip to ankle at rest
const [NOSE, LEFT_EAR, RIGHT_EAR, LEFT_SHOULDER, RIGHT_SHOULDER, LEFT_HIP, RIGHT_HIP] = [0, 7, 8, 11, 12, 23, 24];

/** The skeleton at rest, for `avatar.retarget`. */
export const RIG = {
  names: JOINTS.map(([name]) => name),
  parents: JOINTS.map(([, parent]) => parent),
  rotations: JOINTS.flatMap(() => [0, 0, 0, 1]),
  positions: JOINTS.flatMap(([, , place]) => place),
};

/** Its joints in the world as 33 world landmarks have them, for what `avatar.retarget` gives. */
export function jointsOf(landmarks) {
  const points = landmarks.map(({ x, y, z }) => new Vector3(x, -y, -z)); // theirs have Y down, and Z away from the camera
  const between = (from, to) => points[to].clone().sub(points[from]);
  const middle = (one, other) => points[one].clone().add(points[other]).divideScalar(2);
  const up = middle(LEFT_SHOULDER, RIGHT_SHOULDER).sub(middle(LEFT_HIP, RIGHT_HIP));
  const ahead = points[NOSE].clone().sub(middle(LEFT_EAR, RIGHT_EAR));
  const left = between(RIGHT_EAR, LEFT_EAR);
  const trunk = {
    Hips: turned(between(RIGHT_HIP, LEFT_HIP), up),
    Spine: turned(between(RIGHT_SHOULDER, LEFT_SHOULDER), up),
    Head: turned(left, ahead.cross(left)),
  };
  const turns = [];
  for (const [i, [name, parent, place, from, to]] of JOINTS.entries()) {
    const above = trunk[name] ?? turns[parent];
    const rest = new Vector3(...(JOINTS[i + 1]?.[2] ?? place)).sub(new Vector3(...place)).normalize();
    turns.push(from === undefined ? above : bent(above, rest, between(from, to)));
  }
  const lift = lifted(points) * LEG;
  const positions = RIG.positions.map((value, i) => value + (i % 3 === 1 ? lift : 0));
  return { rotations: turns.flatMap((turn) => turn.toArray()), positions };
}

/** The turn of a part of the trunk of which left and up are seen. */
function turned(left, up) {
  const ahead = left.clone().cross(up).normalize();
  const across = up.clone().cross(ahead).normalize();
  return new Quaternion().setFromRotationMatrix(new Matrix4().makeBasis(across, ahead.clone().cross(across), ahead));
}

/** The turn of the part above, then the shortest one that lays the bone as it is seen. */
function bent(above, rest, seen) {
  const carried = rest.clone().applyQuaternion(above);
  return new Quaternion().setFromUnitVectors(carried, seen.clone().normalize()).multiply(above);
}

/** How much higher than standing the hips are above the lower ankle, in legs: less than 0 while knees bend. */
function lifted(points) {
  const legs = [points.slice(23, 29).filter((_, i) => i % 2 === 0), points.slice(23, 29).filter((_, i) => i % 2 === 1)];
  const long = Math.max(...legs.map(([hip, knee, ankle]) => hip.distanceTo(knee) + knee.distanceTo(ankle)));
  const high = Math.max(...legs.map(([hip, , ankle]) => hip.y - ankle.y));
  return Math.min(high / long, 1) - 1;
}
