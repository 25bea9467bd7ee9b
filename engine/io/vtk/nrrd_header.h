/// What the header of an NRRD file says of the space that its data lie in (teem.sourceforge.net/nrrd/format.html), read from its text: the
/// answers of a library about it depend on the library's version.
///   world = origin + sum over axes of direction[axis] * index[axis];   vector in space = sum over k of frame[k] * component[k]
/// The space of a patient is named by where its axes point to; its axes are turned to right, anterior, superior by `signs`.
#pragma once
#include <array>
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "engine/field/mapping.h"

namespace catena::vtk {

/// What the numbers of one voxel are.
enum class NrrdRange {
  scalar,      ///< one number
  directions,  ///< vectors and normals: turned with the space, and by the measurement frame
  points,      ///< points in the space: turned with it
  numbers,     ///< colours, lists, complex numbers: no relation to the space
  other,       ///< matrices and quaternions
};

struct NrrdHeader {
  std::string space;                            ///< in lower case, without hyphens; empty: none
  std::vector<std::string> kinds;               ///< one for each axis, as written; empty: not stated
  std::vector<std::vector<double>> directions;  ///< one for each axis; an empty one: "none"
  std::vector<double> origin;
  std::vector<std::vector<double>> measurement_frame;  ///< the columns of the measurement frame; empty: the axes of the space
  std::size_t space_dimension = 0;

  bool is_patient() const;
  /// Of x and y, from this space to right, anterior, superior; (1, 1) where it is not a patient's.
  std::array<double, 2> ras_signs() const;
  /// World from index along the first three axes of the domain, turned by `signs`; nullopt: the header names neither
  /// directions nor a patient's space.
  std::optional<field::Mapping> mapping() const;
  /// The kind of the axis that counts the numbers of a voxel; empty: there is none.
  std::string range_kind() const;
  NrrdRange range() const;
  /// The axis (from 1) that has neither a kind nor a direction in a space that others have one in; 0: none.
  std::size_t ambiguous_axis() const;
};

/// An error is a phrase.
Result<NrrdHeader> parse_nrrd_header(const std::string& text);
/// Of a file, .nrrd or .nhdr.
Result<NrrdHeader> read_nrrd_header(const std::string& path);

}  // namespace catena::vtk
