// SPDX-License-Identifier: MIT
#include "engine/io/volume/unsupported_formats.h"

#include <fmt/format.h>

#include "engine/base/text.h"

namespace catena::field {
namespace {

struct ForeignKind {
  std::string_view endings;  ///< each surrounded by blanks
  std::string_view what;
  std::string_view how;
};

constexpr std::string_view kFiji = "Fiji opens it (File > Import > Bio-Formats) and saves .nrrd (File > Save As > Nrrd)";
constexpr std::string_view kParaView = "ParaView opens it and saves .vtu or .vti (File > Save Data)";
constexpr std::string_view kMeshio = "\"meshio convert IN OUT.vtu\" (pip install meshio), or ParaView (File > Save Data)";
constexpr std::string_view kNibabel = "\"nib-convert IN OUT.nii.gz\" (pip install nibabel)";
constexpr std::string_view kBlender = "Blender imports it and exports .ply, .stl or .obj";

constexpr ForeignKind kKinds[] = {
    {" .czi .lsm .nd2 .lif .oib .oif .oir .stk .dv .vsi .lei .zvi .flex ", "a microscope image", kFiji},
    {" .png .jpg .jpeg .bmp .gif .webp ", "a 2D image",
     "Fiji combines slices into a volume (File > Import > Image Sequence) and saves .nrrd (File > Save As > Nrrd)"},
    {" .zarr.zip ", "a packed Zarr store", "\"unzip IN -d OUT.zarr\""},
    {" .n5 ", "an N5 store", "Fiji opens it (File > Import > HDF5/N5/Zarr) and saves .nrrd (File > Save As > Nrrd)"},
    {" .cas .cas.h5 .dat.h5 ", "a Fluent case", kParaView},
    {" .h5ad ", "an annotated matrix",
     "python3 -c \"import h5py, numpy; numpy.save('OUT.npy', h5py.File('IN')['NAME'][:])\" with the name of an array as listed by h5ls "
     "(pip install h5py)"},
    {" .xdmf .xmf .xdmf2 .xdmf3 .silo .plt .szplt .d3plot ", "a simulation file", kParaView},
    {" .e .ex2 .exo .exii .g .gen ", "an Exodus file", kParaView},
    {" .msh .inp .med .bdf .nas .unv .mesh .meshb ", "a finite element mesh", kMeshio},
    {" .grib .grb .grib2 .grb2 .gb2 ", "a GRIB file", "\"cdo -f nc copy IN OUT.nc\" (package cdo)"},
    {" .nc4 .cdl ", "a NetCDF file with another extension", "rename a binary file to .nc; \"ncgen -o OUT.nc IN\" converts a text file"},
    {" .mrc .mrcs .rec .ccp4 .map ", "an electron microscopy map",
     "python3 -c \"import mrcfile, numpy; numpy.save('OUT.npy', mrcfile.read('IN'))\" (pip install mrcfile)"},
    {" .fits .fit .fts ", "a FITS image",
     "python3 -c \"import numpy; from astropy.io import fits; numpy.save('OUT.npy', fits.getdata('IN'))\" (pip install astropy)"},
    {" .mat ", "a MATLAB file",
     "python3 -c \"import numpy; from scipy.io import loadmat; numpy.save('OUT.npy', loadmat('IN')['NAME'])\" (pip install scipy)"},
    {" .mgz .mgh .hdr .img .hdr.gz .img.gz .mnc .par ", "a medical image of another format", kNibabel},
    {" .mif .mif.gz .mih ", "an MRtrix image", "\"mrconvert IN OUT.nii.gz\" (MRtrix3)"},
    {" .las .laz .e57 .pcd .copc ", "a point cloud", "\"pdal translate IN OUT.csv\" (package pdal)"},
    {" .step .stp .iges .igs .brep ", "a CAD model", "\"gmsh IN -2 -o OUT.stl\" (package gmsh)"},
    {" .gltf .glb .fbx .dae .3mf .off .3ds .x3d .wrl .vrml .blend .usd .usdz ", "a triangle model", kBlender},
    {" .trx .tt .tt.gz .trk.gz .fib .fib.gz ", "a tractogram of another format", "\"tckconvert\" (MRtrix3) or nibabel writes .tck or .trk"},
};

}  // namespace

std::string conversion_hint(std::string_view path) {
  while (path.size() > 1 && path.ends_with('/')) path.remove_suffix(1);
  for (const ForeignKind& kind : kKinds) {
    std::string_view remaining = kind.endings.substr(1);
    for (std::size_t end = remaining.find(' '); end != std::string_view::npos; remaining.remove_prefix(end + 1), end = remaining.find(' '))
      if (has_extension(path, remaining.substr(0, end)))
        return fmt::format("{}, which is not supported; to convert it: {}", kind.what, kind.how);
  }
  return {};
}

}  // namespace catena::field
