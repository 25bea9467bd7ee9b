// SPDX-License-Identifier: MIT
/// Private to this module: shared by the readers of medical images (open_itk.cpp, open_dicom.cpp).
#pragma once
#include <itkImageIOBase.h>
#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkSmartPointer.h>

#include <string>

#include "engine/base/result.h"
#include "engine/field/mapping.h"

namespace catena::vtk {

/// Message of an ITK exception, without the name and the address of its object.
std::string error_message(const itk::ExceptionObject& error);

/// Text of a header entry, without trailing blanks; empty: missing.
std::string metadata_text(const itk::MetaDataDictionary& words, const std::string& key);

/// VTK's constant for the type of the voxels; 0: none.
int to_vtk_type(itk::IOComponentEnum type);

/// Index-to-world mapping of the first three axes of an image; axes that the image does not have get a step of 1.
field::Mapping read_mapping(const itk::ImageIOBase& io);
/// Converts a mapping from ITK's world (LPS: left, back, head) to Catena's (RAS: right, front, head).
field::Mapping ras_from_lps(const field::Mapping& mapping);

/// Voxels per axis; further axes of an image count volumes, stored one after the other.
struct ImageExtent {
  int size[3] = {1, 1, 1};
  int volume_count = 1;
  std::size_t voxel_count() const {
    return static_cast<std::size_t>(size[0]) * static_cast<std::size_t>(size[1]) * static_cast<std::size_t>(size[2]);
  }
};
/// Returns the extent of an image, or an Error with a message fragment.
Result<ImageExtent> read_image_extent(const itk::ImageIOBase& io);

/// Reads all voxels, of all volumes, in storage order. ITK throws.
Result<vtkSmartPointer<vtkDataArray>> read_all_voxels(itk::ImageIOBase& io, std::size_t all_voxels);

/// Creates a VTK image from voxels, x fastest. Its mapping is stored separately (Block::mapping).
vtkSmartPointer<vtkImageData> make_image_data(const int (&size)[3], const vtkSmartPointer<vtkDataArray>& values, const std::string& name);

}  // namespace catena::vtk
