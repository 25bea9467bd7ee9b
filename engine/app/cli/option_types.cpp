// SPDX-License-Identifier: MIT
#include "engine/app/cli/option_types.h"

namespace catena::app {

namespace {

// name, input_kind, unit, range, example, is_number
constexpr OptionType kOptionTypes[] = {
    // numbers
    {"ALPHA", "number", "", "", "0.01", true},
    {"BITS", "whole number", "bits", "", "16", true},
    {"CORE", "whole number", "", "", "2", true},
    {"DEG", "number", "degrees", "", "30", true},
    {"DISTANCE", "number", "world units", "", "0.1", true},
    {"D_Z", "number", "standard deviations", "", "0.5", true},
    {"ERROR", "number", "world units", "", "1e-3", true},
    {"FACTOR", "number", "", "", "2", true},
    {"FPS", "number", "frames/s", "", "60", true},
    {"FRAMES", "whole number", "frames", "", "120", true},
    {"HZ", "number", "Hz", "", "2000", true},
    {"INDEX", "whole number", "", "", "1", true},
    {"LENGTH", "number", "world units", "", "5", true},
    {"MB", "number", "MB", "", "4096", true},
    {"N", "whole number", "", "", "4", true},
    {"NODES", "whole number", "nodes", "", "64", true},
    {"NX NY NZ", "3 whole numbers", "voxels", "", "64 64 32", true},
    {"PHASE", "number", "periods", "", "0.25", true},
    {"PORT", "whole number", "", "", "8080", true},
    {"POWER", "number", "", "", "0.9", true},
    {"S", "number", "s", "", "10", true},
    {"SAMPLES", "whole number", "samples", "", "512", true},
    {"SPEED", "number", "unit of the field", "", "0.01", true},
    {"SUBJECT", "whole number", "", "", "7", true},
    {"TOLERANCE", "number", "domain length L", "", "1e-8", true},
    {"US", "number", "us", "", "20", true},
    {"VOXELS", "number", "voxels", "", "0.25", true},
    {"X Y Z", "3 numbers", "", "", "0.5 0.5 1", true},
    // numbers that the commands check themselves
    {"START END", "2 numbers", "time", "", "0 10"},
    {"LO HI", "2 numbers", "", "LO < HI", "-1 1"},
    {"LO,HI", "2 numbers, 4, or one", "unit of the field", "rising", "-8,-3,3,8"},
    {"LABELS=OPACITY", "labels and a number", "", "0 to 1", "1-20=0.2"},
    {"FX,FY,FZ", "three factors", "", "> 0", "1,1,0.01"},
    {"V,A,V,A...", "pairs of numbers", "unit of the field, alpha", "rising values, alphas from 0 to 1", "40,0,80,0.2,300,0.8"},
    {"VALUE", "number", "unit of the field", "", "0.01"},
    {"WxH", "width x height", "pixels", "", "640x480"},
    {"X,Y,Z:X,Y,Z:X,Y,Z", "3 points", "world units", "", "1,0,0:0,0,0:0,1,0"},
    {"X,Y,Z:X,Y,Z", "2 points", "world units", "", "0,0,0:1,0,0"},
    {"X,Y,Z", "point", "world units", "", "0.5,0.5,1"},
    // words
    {"ADDRESS", "IP address", "", "", "0.0.0.0"},
    {"COLORMAP", "name", "", "", "viridis"},
    {"DEVICE", "name", "", "[devices](../user/devices.md)", "emulated-falcon"},
    {"FIELD", "name", "", "", "flow"},
    {"FIRST:LAST[:STRIDE]", "whole numbers", "time steps", "", "0:10:2"},
    {"FORMULA", "name", "", "", "hill"},
    {"GRID", "name", "", "", "density"},
    {"HOST", "name", "", "", "lab.example.org"},
    {"I/N", "2 whole numbers", "", "", "1/4"},
    {"LAYOUT", "word", "", "`ortho`", "ortho"},
    {"MESH", "name", "", "", "skull"},
    {"MODE", "word", "", "", "side-by-side"},
    {"NAME=FILE[:GRID]", "name and file", "", "", "flow=flow.vdb:velocity"},
    {"NAME=NUMBER", "name and number", "", "", "depth_noise_mm=4"},
    {"PRESET", "name", "", "", "ct-bone"},
    {"PART", "name", "", "", "camera"},
    {"QUALITY", "word, or word=number", "RMSE in 1/255, ms, voxels", "`draft`, `balanced`, `reference`, `error=E`, `time=MS`, `step=V`",
     "error=2"},
    {"SCREEN", "name", "", "", "front"},
    {"TEXT", "text", "", "", "\"Speed, m/s\""},
    {"TYPE", "word", "", "[types](scene.md#fields)", "int16"},
    {"URL", "origin", "", "", "http://127.0.0.1:8888"},
    {"VIEW", "word", "", "`+x`, `-x`, `+y`, `-y`, `+z`, `-z`, `iso`", "+x"},
    {"WORD", "word", "", "", ""},
    // files
    {"CAMERA.csv", "file", "s, world units, degrees", ".csv", "camera.csv"},
    {"DATA", "file", "", "", "scan.nii.gz"},
    {"FILE", "file", "", "", "assets/scenes/first.json"},
    {"FILE.catlog", "file", "", ".catlog", "out/hand.catlog"},
    {"FILE.csv", "file", "", ".csv", "out/*.csv"},
    {"FILE.exr", "file", "", ".exr", "out/*.exr"},
    {"FILE.json", "file", "", ".json", "out/*.json"},
    {"FILE.png", "file", "", ".png", "out/*.png"},
    {"FIRMWARE", "file", "", "", "firmware.bin"},
    {"FOLDER", "folder", "", "", "out/results"},
    {"FORMULAFILE", "file or folder", "", ".vdb, .zarr", "out/*.vdb"},
    {"GRIDFILE", "file or folder", "", ".vdb, .vti, .nrrd, .nii, .nii.gz, .zarr", "out/*.nrrd"},
    {"HEAD.csv", "file", "s, world units", ".csv", "head.csv"},
    {"HEAD.csv|DEVICE", "file or name", "s, world units", "", "head.csv"},
    {"IMAGE", "file", "", ".png, .exr, .mp4, .webm, .gif", "out/*.png"},
    {"LIBRARY", "file", "", ".so", "./spring.so"},
    {"LINES", "file", "", ".vtp, .csv", "out/*.vtp"},
    {"OLD", "file", "", ".json, .catlog", "old.json"},
    {"OUT", "file", "", "", "out/*.csv"},
    {"OUTPUT", "file or folder", "", ".csv", "out/lines.csv"},
    {"PROBE.csv", "file", "s, world units", ".csv", "assets/probes/first.csv"},
    {"SCENE", "file", "", ".json", "assets/scenes/first.json"},
    {"SEEDS", "file or JSON", "world units", ".csv, .json", "seeds.csv"},
    {"SHADERS", "folder", "", "", "shaders"},
    {"STUDY", "file", "", ".json", "assets/studies/proxy-chain.json"},
};

}  // namespace

const OptionType* find_option_type(std::string_view type_name) {
  for (const OptionType& type : kOptionTypes)
    if (type_name == type.name || type_name.starts_with(std::string(type.name) + ":")) return &type;
  return nullptr;
}

}  // namespace catena::app
