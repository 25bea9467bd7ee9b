// SPDX-License-Identifier: MIT
/// OME metadata of a Zarr group (.zattrs): versions 0.1 to 0.4 of OME-Zarr.
///   multiscales   axes with units, data sets from fine to coarse, each with scale and translation
///   omero         channels: label, display window, color
///   labels, plate, bioformats2raw.layout
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "engine/base/result.h"

namespace catena::chunks {

/// An axis of an image: 't', 'c', 'z', 'y', 'x', and the unit of lengths or times; empty: not specified.
struct OmeAxis {
  char name = 'x';
  std::string unit;
};

/// An array of a pyramid; scale and translation have one number per axis; empty: not specified.
struct OmeDataset {
  std::string path;
  std::vector<double> scale, translation;
};

/// A channel.
struct OmeChannel {
  std::string label;
  std::optional<double> lo, hi;
  int color = -1;  ///< 0xRRGGBB; -1: not specified.
};

/// What .zattrs contains.
struct OmeMetadata {
  bool is_plate = false, is_image = false, is_label = false;
  std::string name;
  std::vector<OmeAxis> axes;  ///< Empty in an image: those of version 0.2, t, c, z, y, x.
  std::vector<OmeDataset> datasets;
  std::vector<OmeChannel> channels;
  std::vector<std::string> labels;      ///< In the group `labels`: its label images.
  std::vector<std::string> dimensions;  ///< Names of an array's axes (xarray).
};

/// Parses the text of .zattrs; `name`: of the file, for messages.
Result<OmeMetadata> parse_ome(const std::string& text, const std::string& name);

/// A length unit's short name ("µm") and its length in meters; 0: unknown.
struct LengthUnit {
  std::string name;
  double meters = 0;
};
/// Returns the length unit with a name of OME ("micrometer") or a short name ("um", "µm", "micron"); an unknown one is kept as it is.
LengthUnit find_length_unit(const std::string& name);

}  // namespace catena::chunks
