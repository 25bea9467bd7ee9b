// SPDX-License-Identifier: MIT
/// Grids of an HDF5 file, by the layout that its groups have:
///   BigDataViewer   sNN/resolutions, tTTTTT/sNN/L/cells; units and transforms from the .xml beside it; integers of 16 bits are unsigned
///   Imaris          DataSet/ResolutionLevel L/TimePoint T/Channel C/Data, DataSetInfo
///   VTKHDF          images: PointData of the group VTKHDF
///   NXdata          the group that `default` leads to, or every group of this class; `signal`, `axes`
///   otherwise       every data set with three axes is a grid
#pragma once
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "engine/io/chunks/hdf5_file.h"
#include "engine/io/stores/store_protocol.h"

namespace catena::chunks {

/// A grid and where its values are.
struct H5Grid {
  field::StoreGrid description;                 ///< Complete, apart from number type, fill value and chunks.
  std::vector<std::vector<std::string>> paths;  ///< Data sets by level and step; one step: it serves all.
  int axis[3] = {2, 1, 0};                      ///< Axes of the data sets along x, y, z; -1: none, one voxel.
  int channel_axis = -1, step_axis = -1;        ///< -1: none.
  std::int64_t channel = 0;
  bool is_unsigned = false;  ///< Signed integers stand for unsigned ones.
};

/// The grids of a file, and its times.
struct H5Layout {
  std::vector<H5Grid> grids;
  std::vector<double> times;
  std::string time_unit;
  std::vector<std::string> notes;
};

/// Finds the grids. `xml`: text of the .xml of BigDataViewer, empty: none. Returns an Error with a message fragment.
Result<H5Layout> find_hdf5_grids(H5File& file, const std::string& xml);

/// The same for a single layout; no grids: the file has another layout.
Result<H5Layout> find_bigdataviewer_grids(H5File& file, const std::string& xml);
Result<H5Layout> find_imaris_grids(H5File& file);
Result<H5Layout> find_vtkhdf_grids(H5File& file);
Result<H5Layout> find_nexus_grids(H5File& file);
Result<H5Layout> find_plain_grids(H5File& file);

}  // namespace catena::chunks
