"""Renders the images of a job with Blender's Cycles; runs in a Python that has bpy and knows nothing of mua.

    python tools/cycles_render.py FOLDER/render/job.json [--threads 2]

A job is the surface (`surface.npz`: faces [F, 3], the UV of each corner [F, 3, 2] with v down), its image
(`texture.png`, sRGB, alpha is opacity), cameras, and images to make: each names a .ply with the vertices, a camera
and the file to write. Images that are there are left as they are, so a job that was stopped goes on where it was.
Images are sRGB with straight alpha, without any film look. The world has Y up; Blender does not mind.
"""

import argparse
import json
import math
from itertools import groupby
from pathlib import Path
from typing import Any

import bpy
import numpy as np
from mathutils import Matrix, Vector

SENSOR = 36.0  # millimetres that lenses are measured against; any number does
SKY = 0.55  # strength of the light from all around
LAMPS = (  # direction to the lamp, strength beside the sky: a soft key from the left, a fill, a rim from behind
    ((-0.7, 0.75, 0.8), 0.9),
    ((0.95, 0.25, 0.55), 0.35),
    ((0.25, 0.6, -1.0), 0.5),
)
LAMP_DISTANCE, LAMP_SIDE = 2.5, 1.6  # times the figure's size
OPEN_SKY = (0.16, 0.21, 0.3)  # light from all around in the sun: red, green, blue
SUN = ((-0.65, 0.75, 0.35), (1.0, 0.93, 0.82), 2.6)  # direction to it, colour, irradiance
SUN_DEGREES = 0.53  # across
BORDER = 4  # pixels around the figure that are rendered; the rest of an image is empty


def render(job_file: Path, *, threads: int) -> None:
    """Make every image of a job that is not there yet, and print how far it is after each frame."""
    folder, job = job_file.parent, json.loads(job_file.read_text())
    missing = [one for one in job["pictures"] if not (folder / one["image"]).exists()]
    done = len(job["pictures"]) - len(missing)
    print(f"rendered {done} of {len(job['pictures'])}", flush=True)
    if not missing:
        return
    scene = _scene(job, threads)
    cameras = {camera["name"]: _camera(scene, camera, job["size"]) for camera in job["cameras"]}
    given = {camera["name"]: camera for camera in job["cameras"]}
    surface = _surface(scene, folder, job)
    for mesh, pictures in groupby(missing, key=lambda one: one["mesh"]):
        _place(surface, folder / mesh)
        for one in pictures:
            scene.camera = cameras[one["camera"]]
            _border(scene, given[one["camera"]], _vertices(folder / mesh), size=job["size"])
            scene.cycles.seed = one["seed"]
            _picture(scene, folder / one["image"])
            done += 1
        print(f"rendered {done} of {len(job['pictures'])}", flush=True)


def _scene(job: dict[str, Any], threads: int) -> Any:
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.device = "CPU"
    scene.cycles.samples = job["samples"]
    scene.cycles.use_adaptive_sampling = False
    scene.cycles.use_denoising = not job["unlit"]  # this pass has no noise
    scene.cycles.pixel_filter_type = "BOX"  # a pixel is the mean of what falls on it, as on a sensor
    scene.cycles.filter_width = 1.0
    scene.render.use_persistent_data = True
    scene.render.threads_mode, scene.render.threads = "FIXED", threads
    scene.render.film_transparent = True
    scene.render.resolution_x = scene.render.resolution_y = job["size"]
    scene.render.resolution_percentage = 100
    scene.render.image_settings.file_format = "PNG"
    scene.render.image_settings.color_mode = "RGBA"
    scene.render.image_settings.color_depth = "8"
    scene.render.dither_intensity = 0.0
    scene.display_settings.display_device = "sRGB"
    scene.view_settings.view_transform = "Standard"
    scene.view_settings.look = "None"
    if job["order"]["light"] == "sun":
        _sky(scene, OPEN_SKY)
        _sun(scene)
    else:
        _sky(scene, (SKY, SKY, SKY))
        for direction, strength in LAMPS:
            _lamp(scene, job, Vector(direction).normalized(), strength)
    return scene


def _sky(scene: Any, colour: tuple[float, float, float]) -> None:
    """Light from all around, whose red, green and blue are the radiance."""
    scene.world = bpy.data.worlds.new("sky")
    scene.world.use_nodes = True
    sky = scene.world.node_tree.nodes["Background"]
    sky.inputs["Color"].default_value, sky.inputs["Strength"].default_value = (*colour, 1), 1.0


def _sun(scene: Any) -> None:
    """Light from one direction, with the edges of shadows that the sun's disc makes."""
    direction, colour, irradiance = SUN
    light = bpy.data.lights.new("sun", "SUN")
    light.color, light.energy, light.angle = colour, irradiance, math.radians(SUN_DEGREES)
    sun = bpy.data.objects.new("sun", light)
    sun.rotation_euler = Vector(direction).to_track_quat("Z", "Y").to_euler()
    scene.collection.objects.link(sun)


def _lamp(scene: Any, job: dict[str, Any], direction: Any, strength: float) -> None:
    """A square of light that shines on the figure; its power follows from what reaches the middle."""
    distance, side = LAMP_DISTANCE * job["figure"]["size"], LAMP_SIDE * job["figure"]["size"]
    light = bpy.data.lights.new("lamp", "AREA")
    light.shape, light.size = "SQUARE", side
    light.energy = strength * math.pi * math.pi * distance**2  # watts for an irradiance of strength * pi
    lamp = bpy.data.objects.new("lamp", light)
    lamp.location = Vector(job["figure"]["middle"]) + distance * direction
    lamp.rotation_euler = (-direction).to_track_quat("-Z", "Y").to_euler()
    lamp.visible_camera = False
    scene.collection.objects.link(lamp)


def _camera(scene: Any, camera: dict[str, Any], size: int) -> Any:
    """A pinhole; Blender's cameras look along -Z with Y up, the job's along Z with Y down."""
    column, row = camera["centre"]
    made = bpy.data.cameras.new(camera["name"])
    made.sensor_fit, made.sensor_width = "HORIZONTAL", SENSOR
    made.lens = camera["focal"] / size * SENSOR
    made.shift_x, made.shift_y = 0.5 - column / size, row / size - 0.5
    made.clip_start, made.clip_end = 1e-2, 1e3
    placed = bpy.data.objects.new(camera["name"], made)
    to_world = np.linalg.inv(np.array(camera["world_to_camera"])) @ np.diag([1.0, -1, -1, 1])
    placed.matrix_world = Matrix(to_world.tolist())
    scene.collection.objects.link(placed)
    return placed


def _border(scene: Any, camera: dict[str, Any], vertices: Any, *, size: int) -> None:
    """Render nothing but the box around the figure, in an image of the same size."""
    to_camera = np.array(camera["world_to_camera"])
    seen = vertices @ to_camera[:3, :3].T + to_camera[:3, 3]
    pixels = camera["focal"] * seen[:, :2] / seen[:, 2:] + camera["centre"]
    left, upper = np.clip((pixels.min(axis=0) - BORDER) / size, 0, 1).tolist()
    right, lower = np.clip((pixels.max(axis=0) + BORDER) / size, 0, 1).tolist()
    scene.render.use_border, scene.render.use_crop_to_border = True, False
    scene.render.border_min_x, scene.render.border_max_x = left, right
    scene.render.border_min_y, scene.render.border_max_y = 1 - lower, 1 - upper


def _surface(scene: Any, folder: Path, job: dict[str, Any]) -> Any:
    """The mesh of the job without its places."""
    with np.load(folder / "surface.npz") as held:
        faces, uv = held["faces"], held["uv"].reshape(-1, 2)
    mesh = bpy.data.meshes.new("surface")
    mesh.from_pydata(_vertices(folder / job["pictures"][0]["mesh"]), [], faces.tolist())
    layer = mesh.uv_layers.new(name="uv")
    layer.data.foreach_set("uv", np.stack([uv[:, 0], 1 - uv[:, 1]], axis=1).astype(np.float32).ravel())
    mesh.shade_smooth()
    mesh.materials.append(_material(folder / "texture.png", unlit=job["unlit"]))
    scene.collection.objects.link(bpy.data.objects.new("surface", mesh))
    return mesh


def _material(texture: Path, *, unlit: bool) -> Any:
    """Cloth and skin in one: somewhat rough, with a highlight and a sheen, so that the look changes with the view."""
    material = bpy.data.materials.new("surface")
    material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    picture = nodes.new("ShaderNodeTexImage")
    picture.image = bpy.data.images.load(str(texture.absolute()))
    look = nodes["Principled BSDF"]
    if unlit:
        look.inputs["Base Color"].default_value = (0, 0, 0, 1)
        look.inputs["Specular IOR Level"].default_value = 0.0
        look.inputs["Emission Strength"].default_value = 1.0
        links.new(picture.outputs["Color"], look.inputs["Emission Color"])
    else:
        look.inputs["Roughness"].default_value = 0.45
        look.inputs["Sheen Weight"].default_value = 0.25
        links.new(picture.outputs["Color"], look.inputs["Base Color"])
    links.new(picture.outputs["Alpha"], look.inputs["Alpha"])
    return material


def _place(surface: Any, file: Path) -> None:
    """Move the vertices to where a .ply has them."""
    surface.vertices.foreach_set("co", _vertices(file).ravel())
    surface.update()


def _vertices(
    file: Path,  # binary, its first element the vertices as three floats each
) -> Any:
    """[V, 3] float32."""
    content = file.read_bytes()
    end = content.index(b"end_header\n") + len(b"end_header\n")
    count = next(int(line.split()[2]) for line in content[:end].split(b"\n") if line.startswith(b"element vertex"))
    return np.frombuffer(content, "<f4", 3 * count, end).reshape(-1, 3)


def _picture(scene: Any, file: Path) -> None:
    """Render to a file beside `file` that takes its name when it is whole."""
    file.parent.mkdir(parents=True, exist_ok=True)
    part = file.with_name(f".{file.name}")
    scene.render.filepath = str(part.absolute())
    bpy.ops.render.render(write_still=True)
    part.replace(file)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("job", type=Path, help="the job.json that tools/render_capture.py wrote")
    parser.add_argument("--threads", type=int, default=2, help="processor cores to render on")
    given = parser.parse_args()
    render(given.job, threads=given.threads)


if __name__ == "__main__":
    main()
