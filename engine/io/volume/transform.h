// SPDX-License-Identifier: MIT
/// Affine transforms of fields from files: the data move from the position that the file states to another one. Scalar fields keep their
/// voxels, so that images and forces are exact; vectors are multiplied by the matrix of the map. Files of transforms:
///   ITK   text (.tfm, .txt) with one affine, rigid, similarity or translation transform. ITK maps positions of the fixed image to the
///         moving one, in LPS axes; the field is the moving image, hence the map that is applied is the inverse, in RAS axes.
///   FSL   text of flirt (.mat): 4 x 4 numbers between millimeters along the voxel axes of the moving image and of a reference image,
///         x reversed where the voxel axes are right-handed.
/// Any thread.
#pragma once
#include <string>

#include "engine/base/affine.h"
#include "engine/io/volume/load_field.h"

namespace catena::field {

/// Reads a 4 x 4 matrix in text, as of flirt. Error: no such matrix, or a last row other than 0 0 0 1.
Result<AffineMap> read_matrix_file(const std::string& path);
/// Reads a transform file of ITK. Returns the map to apply to the moving image, in RAS axes. Error: another format, several transforms, a
/// type that is not affine, or a matrix that cannot be inverted.
Result<AffineMap> read_itk_transform(const std::string& path);
/// Returns the map between world positions for a matrix of flirt; `size`: voxels of the moving image. Error: the reference image cannot be
/// read.
Result<AffineMap> world_map_of_flirt(const AffineMap& matrix, const Mapping& moving, const Size3& size, const std::string& reference);

/// Returns the field of a file at its new position. Error: that of the reference image, or a map that cannot be inverted.
Result<AnyField> transform_field(const std::string& path, AnyField field, const FieldTransform& transform);

}  // namespace catena::field
