"""Numbers of the format that its readers share; tools/gen_layout.py writes them for C# and JavaScript."""

MAJOR, MINOR = 1, 2  # version
MAX_RANK = 4  # sides of a tensor
LARGEST = 65504.0  # largest magnitude of any real: f16's largest
UNPACKED_TIMES, UNPACKED_ROOM = 16, 1 << 20  # bytes that packed tensors give, for each of the file, and beside
LEAST_STEP, LARGEST_STEP = 2.0**-24, 1.0  # scales of halves that are packed as steps: no multiple is infinite
STAGES = 5

MAX_JOINTS, MAX_LAYERS, MAX_CLIPS, MAX_EXPRESSIONS = 4096, 64, 4096, 1024
RULE_CODES = 1 << 7  # what the rules of an expression may be
MAX_LEVELS = 8  # levels of the wavelet
MAX_SIDE = 4096  # texels along a side of the texture
TEXTURE_TIMES, TEXTURE_ROOM = 16, 1 << 16  # texels of the texture for each valid one, and beside
MAX_DETAIL_LEVELS = 2  # coarser levels
MOST_TAPS = 32  # taps of a wavelet with levels of detail: UpsampleTexels holds no more samples of a tile
GROWTH = 1.85  # factor of the standard deviations where one splat replaces four, so that the figure covers as much

UNIT_BOUND = 2e-3  # a unit quaternion rounded to f16 leaves 1 by at most 4 x 2^-11
WEIGHT_BOUND = 1e-4  # 8 weights rounded to f32, with room for a writer that rounds to f16-derived values
BIND_BOUND = 1e-4  # metres and quaternion components: f32 forward kinematics over a deep chain
BARYCENTRIC_SLACK = 2.0**-21  # the third is a rounded difference
MAX_INFLUENCES = 8  # joints of a vertex
MAX_TAPS = 40
LARGEST_TAP = 16.0  # the taps of PyWavelets' wavelets stay below 5
MAX_WINDOW = 16  # frames
LEAST_RATE, LARGEST_RATE = 1.0, 1000.0  # frames per second
MAX_FRAMES = 1 << 20  # frames of a clip at the encoding's rate: 9 hours at 30 frames per second
MAX_ADDED = (
    1 << 24
)  # joints and weights in all frames that clips gain at the encoding's rate: 46 minutes of 100, 30 to 90 Hz
LEAST_SCALE = 1e-6  # least scale of a descriptor's number: a thousandth of a person's unit, for a figure 2 mm high
MAGNITUDE = 2.0**62  # bound of decoded values: the squares of four such numbers have a finite sum in single precision
