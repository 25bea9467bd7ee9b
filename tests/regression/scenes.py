# SPDX-License-Identifier: MIT
"""Scenes for unchanged.py: generated ones that use every part of a scene, and bad ones. All by one seed: the same scenes everywhere."""
import copy
import json
import random

SCALARS = ["ball", "hill_speed", "grid", "bumps"]
VECTORS = ["flow", "twist", "swirl"]
FIELDS = {
    "ball": {"analytic": "sphere", "resolution": 24},
    "hill_speed": {"analytic": "gaussian", "resolution": 20},
    "grid": {"file": "data/torus.vdb"},
    "bumps": {"analytic": "marschner-lobb", "resolution": 24},
    "flow": {"analytic": "hill", "resolution": 20},
    "twist": {"analytic": "helix", "resolution": 20},
    "swirl": {"file": "data/abc.vdb"},
}
LEVELS = {"ball": 0.8, "hill_speed": 0.6, "grid": 0.7, "bumps": 0.5}
MAPS = ["viridis", "plasma", "grey"]


def vector(r, lo=-1.0, hi=1.0):
    return [round(r.uniform(lo, hi), 3) for _ in range(3)]


def unit(r):
    while True:
        v = vector(r)
        if sum(x * x for x in v) > 0.1:
            return v


def value_of(r, key, schema, link_type):
    """A value for a link's key, by its schema: usually a valid one."""
    if "oneOf" in schema:
        schema = schema["oneOf"][0]
    if "enum" in schema:
        return r.choice(schema["enum"])
    kind = schema.get("type")
    if kind == "boolean":
        return r.random() < 0.5
    if kind == "number":
        return round(r.uniform(0.02, 0.9), 3)
    if kind == "integer":
        return r.randint(1, 3)
    if kind == "string":
        if key == "surface":
            return r.choice(SCALARS)
        if key == "field":
            return r.choice(SCALARS if link_type in ("isosurface", "gradient_force") else VECTORS)
        return "none"
    if kind == "array" and schema.get("items", {}).get("type") == "number":
        return [abs(x) + 0.2 for x in unit(r)] if key == "size" else unit(r)
    if kind == "array":
        return [vector(r) for _ in range(r.randint(2, 5))]
    if kind == "object" and key in ("on", "active_when"):
        return {"button": 1}
    if kind == "object" and key in ("indicate", "release_cue"):
        return {"type" if key == "release_cue" else "cue": r.choice(["detent", "vibration", "none"])}
    return {}


def link(r, schema, index):
    properties = schema["properties"]
    word = properties["type"]["const"]
    out = {"name": "link%d" % index, "type": word}
    for key, about in properties.items():
        if key in ("name", "type", "mesh"):
            continue
        if key in schema["required"] or r.random() < 0.15:
            out[key] = value_of(r, key, about, word)
    if "mesh" in properties:
        out["mesh"] = "cube"
    # what belongs together
    if "snap" in out and "release" in out:
        del out["release"]
    if "level" in out and "surface" in properties and "surface" not in out:
        out["surface"] = r.choice(SCALARS)
    if "surface" in out and "level" in properties or "level" in out:
        out["level"] = LEVELS[out.get("surface", out.get("field"))]
    if word == "viscosity":
        out.pop("coefficient", None)
        out["time"] = 0.05
    if word in ("texture", "viscosity", "drag", "gradient_force"):
        out.pop("align", None)
    return out


def transfer(r):
    if r.random() < 0.5:
        return {"color": r.choice(MAPS), "opacity": [[0.2, 0], [1.2, round(r.uniform(0.1, 0.9), 2)]]}
    return {"color": [[0, 0.1, 0.2, 0.9], [1, 0.9, 0.8, 0.1]], "opacity": [[0, 0], [0.8, 0.4]], "opacity_unit": 0.2}


def seeds(r):
    return r.choice([
        [vector(r) for _ in range(3)],
        {"line": {"from": vector(r), "to": vector(r), "count": 4}},
        {"sphere": {"center": [0, 0, 0], "radius": 0.7, "count": 6, "inside": True}},
        {"plane": {"origin": [-1, -1, 0.1], "u": [2, 0, 0], "v": [0, 2, 0], "count": [3, 3]}},
        {"isosurface": {"field": "ball", "level": 0.8, "count": 4}},
    ])


def generated(r, chain_schema):
    scene = {"fields": dict(FIELDS)}
    links = chain_schema["items"]["oneOf"]
    scene["chain"] = [link(r, r.choice(links), i) for i in range(r.randint(0, 3))]
    if any("mesh" in one for one in scene["chain"]) or r.random() < 0.2:
        scene["meshes"] = [{"name": "cube", "file": "data/cube.obj", "opacity": r.choice([1, 0.5]), "shading": r.choice(["flat", "smooth"])}]
    if r.random() < 0.4:
        scene["volumes"] = [dict({"field": r.choice(SCALARS)}, shade=r.random() < 0.5, **transfer(r))]
        if r.random() < 0.3:
            scene["volumes"][0]["projection"] = r.choice(["maximum", "minimum", "average"])
    if r.random() < 0.5:
        scene["isosurfaces"] = [{"field": r.choice(SCALARS), "opacity": r.choice([1, 0.4])}]
        scene["isosurfaces"][0]["level"] = LEVELS[scene["isosurfaces"][0]["field"]]
        if r.random() < 0.3:
            scene["isosurfaces"][0]["color_by"] = {"field": r.choice(SCALARS), "color": r.choice(MAPS)}
    if r.random() < 0.4:
        scene["slices"] = [{"field": r.choice(SCALARS + VECTORS), "axis": r.choice("xyz"), "at": round(r.uniform(-0.8, 0.8), 2),
                            "color": r.choice(MAPS)}]
        if r.random() < 0.4:
            scene["slices"][0]["contours"] = {"count": 4}
    if r.random() < 0.5:
        scene["streamlines"] = [{"field": r.choice(VECTORS), "seeds": seeds(r), "color_by": r.choice(["speed", "arc_length"]), "color": "plasma"}]
        if r.random() < 0.3:
            scene["streamlines"][0]["arrows"] = 3
    if r.random() < 0.35:
        scene["widgets"] = [r.choice([
            {"name": "w", "type": "cutting_plane", "center": vector(r, -0.3, 0.3), "normal": unit(r)},
            {"name": "w", "type": "seed", "position": vector(r, -0.5, 0.5)},
            {"name": "w", "type": "rake", "from": [-0.5, 0, 0], "to": [0.5, 0.1, 0]},
            {"name": "w", "type": "isolevel", "field": "ball", "position": [0.6, 0, 0]},
            {"name": "w", "type": "box", "lo": [-0.5, -0.5, -0.5], "hi": [0.5, 0.5, 0.5]},
            {"name": "w", "type": "ruler", "from": [0, 0, 0], "to": [0.7, 0, 0]},
        ])]
        word = scene["widgets"][0]["type"]
        if word == "cutting_plane" and r.random() < 0.6:
            scene["slices"] = [{"field": "ball", "widget": "w"}]
        if word in ("cutting_plane", "box") and r.random() < 0.6:
            scene["clip"] = [{"widget": "w"}]
        if word in ("seed", "rake") and r.random() < 0.6:
            scene["streamlines"] = [{"field": "flow", "seeds": {"widget": "w", "count": 5} if word == "rake" else {"widget": "w"}}]
        if word == "isolevel" and r.random() < 0.6:
            scene["isosurfaces"] = [{"field": "ball", "level": {"widget": "w"}}]
    for key, share in (("bounding_box", 0.3), ("axes", 0.3), ("orientation_marker", 0.2), ("ground", 0.1), ("fog", 0.1)):
        if r.random() < share:
            scene[key] = True
    if r.random() < 0.1:
        scene["title"] = "a title"
    if r.random() < 0.1:
        scene["labels"] = [{"at": vector(r), "text": "here"}]
    if r.random() < 0.2 and "volumes" in scene:
        scene["scalar_bars"] = [{"volume": 0, "title": "density"}]
    if r.random() < 0.2:
        scene["lights"] = [{"direction": unit(r), "intensity": 0.8}]
    if r.random() < 0.1:
        scene["stereo"] = {"mode": r.choice(["side-by-side", "anaglyph", "top-bottom"])}
    if r.random() < 0.3:
        scene["coupling"] = {"stiffness": r.choice([200, 500]), "damping": r.choice([0, 1.0]), "max_force": r.choice([3, 8])}
        if r.random() < 0.2:
            scene["coupling"]["method"] = r.choice(["pipe", "balance", "closest", "linear"])
    if r.random() < 0.3:
        scene["workspace"] = {"metres_per_unit": r.choice([0.01, 0.05]), "origin": vector(r, -0.1, 0.1)}
    if len(scene["chain"]) > 1 and r.random() < 0.2:
        scene["modes"] = [{"name": "swap", "links": [scene["chain"][1]["name"], scene["chain"][0]["name"]], "on": {"button": 1}}]
    return scene


def places(node, at=()):
    """Every place in a scene, as a path of keys."""
    yield at
    if isinstance(node, dict):
        for key, inner in node.items():
            yield from places(inner, at + (key,))
    if isinstance(node, list):
        for i, inner in enumerate(node):
            yield from places(inner, at + (i,))


def spoiled(r, scene):
    """A scene with one fault: a wrong value, a key that is unknown or lacks, a name of nothing. As text."""
    scene = copy.deepcopy(scene)
    at = r.choice([p for p in places(scene) if p])
    parent = scene
    for key in at[:-1]:
        parent = parent[key]
    fault = r.randint(0, 5)
    if fault == 0:
        parent[at[-1]] = r.choice([None, "nothing", -1, 1e308, [], {}, True, [1, 2], "widget"])
    elif fault == 1 and isinstance(parent, dict):
        parent[str(at[-1]) + "x"] = parent.pop(at[-1])
    elif fault == 2 and isinstance(parent, dict):
        del parent[at[-1]]
    elif fault == 3 and isinstance(parent, dict):
        parent["unknown"] = 1
    elif fault == 4:
        text = json.dumps(scene, indent=1)
        cut = r.randrange(len(text))
        return text[:cut] + r.choice(["", ",", "}", "\"", "1e999"]) + text[cut + 1:]
    else:
        parent[at[-1]] = {"field": "no_such", "widget": "no_such"}
    return json.dumps(scene, indent=1)


def all_of(chain_schema, generated_count, bad_count):
    """[(name, text)]"""
    r = random.Random(20260101)
    out = []
    whole = []
    for i in range(generated_count):
        whole.append(generated(r, chain_schema))
        out.append(("generated-%03d" % i, json.dumps(whole[-1], indent=1)))
    for i in range(bad_count):
        out.append(("bad-%02d" % i, spoiled(r, r.choice(whole))))
    return out
