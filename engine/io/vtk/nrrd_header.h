// SPDX-License-Identifier: MIT
/// Space and kind of the data in an NRRD file (teem.sourceforge.net/nrrd/format.html), parsed from the text of its header, because the
/// results of a library depend on its version.
///   world = origin + sum over axes of direction[axis] * index[axis];   vector in space = sum over k of frame[k] * component[k]
/// A patient space is named by the directions of its axes; they are converted to right, anterior, superior by ras_signs().
#pragma once
#include <array>
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "engine/field/mapping.h"

namespace catena::vtk {

/// Meaning of the numbers of one voxel.
enum class NrrdRange {
  scalar,      ///< One number.
  directions,  ///< Vectors and normals: transformed with the space, and by the measurement frame.
  points,      ///< Points in the space: transformed with it.
  numbers,     ///< Colors, lists, complex numbers: unrelated to the space.
  other,       ///< Matrices and quaternions.
};

/// The parsed header.
struct NrrdHeader {
  std::string space;                            ///< In lower case, without hyphens; empty: none.
  std::vector<std::string> kinds;               ///< One per axis, as written; empty: not specified.
  std::vector<std::vector<double>> directions;  ///< One per axis; an empty vector: "none".
  std::vector<double> origin;
  std::vector<std::vector<double>> measurement_frame;  ///< Columns of the measurement frame; empty: the axes of the space.
  std::size_t space_dimension = 0;

  /// Returns whether `space` is a patient space.
  bool is_patient() const;
  /// Signs that convert x and y of this space to right and anterior; (1, 1) if it is not a patient space.
  std::array<double, 2> ras_signs() const;
  /// World from index for the first three domain axes, with ras_signs() applied; nullopt: the header specifies neither directions nor a
  /// patient space.
  std::optional<field::Mapping> mapping() const;
  /// Kind of the axis that counts the numbers of a voxel; empty: there is no such axis.
  std::string range_kind() const;
  /// Meaning of the numbers of a voxel, from range_kind().
  NrrdRange range() const;
  /// The axis (from 1) that has neither a kind nor a direction, if the number of domain axes does not match the space; 0: none.
  std::size_t ambiguous_axis() const;
};

/// Parses the text of a header. Returns an Error with a message fragment.
Result<NrrdHeader> parse_nrrd_header(const std::string& text);
/// Reads the header of a file, .nrrd or .nhdr.
Result<NrrdHeader> read_nrrd_header(const std::string& path);

}  // namespace catena::vtk
