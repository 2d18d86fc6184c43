"""trimesh: `trimesh.load_scene` of 3MF and STL; prints what it says of each body."""

import json
import sys
from importlib.metadata import version

import trimesh

scene = trimesh.load_scene(sys.argv[1])
bodies = scene.dump()  # each where it is placed
print(
    json.dumps(
        {
            "version": version("trimesh"),
            "units": scene.units,
            "bodies": [
                {
                    "watertight": bool(body.is_watertight),
                    "oriented": bool(body.is_winding_consistent),
                    "volume": float(body.volume),
                    "low": body.bounds[0].tolist(),
                    "high": body.bounds[1].tolist(),
                }
                for body in bodies
            ],
        }
    )
)
