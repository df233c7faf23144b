"""Writes a material and a scene for Mitsuba 3.

    python mitsuba_scene.py [FOLDER [BASIS]]

Then: mitsuba FOLDER/scene.xml. Mitsuba is not needed to write them.
"""
# %%
import pathlib
import sys
import xml.etree.ElementTree as xml

import gonio

folder = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".")
basis = gonio.Basis.load(sys.argv[2]) if len(sys.argv) > 2 else gonio.builtin_basis()

# %% A material, completed from 20 readings.
plan = basis.plan(20)
values = gonio.SimulatedInstrument("atlas:sapphire-metallic").read(plan.wi, plan.wo)
made = gonio.Regressor(basis).fit(plan.directions, values).reconstruction_
made.save(folder / "material.bsdf")


# %% The scene: a sphere of it under a constant sky and a lamp.
def add(parent, tag, kind=None, **attributes):
    return xml.SubElement(parent, tag, {**({"type": kind} if kind else {}), **attributes})


scene = xml.Element("scene", version="3.0.0")
add(scene, "integrator", "path")
sensor = add(scene, "sensor", "perspective")
add(sensor, "float", name="fov", value="30")
add(add(sensor, "transform", name="to_world"), "lookat", origin="0, 0, 5", target="0, 0, 0", up="0, 1, 0")
film = add(sensor, "film", "hdrfilm")
add(film, "integer", name="width", value="256")
add(film, "integer", name="height", value="256")
add(add(sensor, "sampler", "independent"), "integer", name="sample_count", value="64")
sphere = add(scene, "shape", "sphere")
add(add(sphere, "bsdf", "measured"), "string", name="filename", value="material.bsdf")
add(add(scene, "emitter", "constant"), "rgb", name="radiance", value="0.3")
lamp = add(scene, "emitter", "directional")
add(lamp, "vector", name="direction", x="1", y="-1", z="-1")
add(lamp, "rgb", name="irradiance", value="3")
xml.indent(scene)
xml.ElementTree(scene).write(folder / "scene.xml", encoding="utf-8", xml_declaration=True)

# %% How it should look: gonio's own rendering.
picture = gonio.render(made, width=256, height=256, samples=16)
gonio.save_image(picture, folder / "expected.png")
print(f"{folder / 'scene.xml'}: render it with mitsuba, and compare with {folder / 'expected.png'}")
