/// Private to this room: what the readers of medical images have in common (open_itk.cpp, open_dicom.cpp).
#pragma once
#include <itkImageIOBase.h>
#include <vtkDataArray.h>
#include <vtkImageData.h>
#include <vtkSmartPointer.h>

#include <string>

#include "engine/base/result.h"
#include "engine/field/mapping.h"

namespace catena::vtk {

/// What ITK says went wrong, without the name and the address of its object.
std::string error_message(const itk::ExceptionObject& error);

/// A text of the header by its key, without blanks at its end; empty: there is none.
std::string metadata_text(const itk::MetaDataDictionary& words, const std::string& key);

/// VTK's number for the type of the voxels; 0: it has none.
int to_vtk_type(itk::IOComponentEnum type);

/// Columns: the steps of the image's first three axes; an image of fewer has steps of 1 across.
field::Mapping read_mapping(const itk::ImageIOBase& io);
/// From ITK's world, left, back, head of a patient, to Catena's, right, front, head.
field::Mapping ras_from_lps(const field::Mapping& mapping);

/// Voxels an axis; further axes of an image are volumes, one behind the other.
struct ImageExtent {
  int size[3] = {1, 1, 1};
  int volume_count = 1;
  std::size_t voxel_count() const {
    return static_cast<std::size_t>(size[0]) * static_cast<std::size_t>(size[1]) * static_cast<std::size_t>(size[2]);
  }
};
/// An error is a phrase.
Result<ImageExtent> read_image_extent(const itk::ImageIOBase& io);

/// All voxels, of all volumes, as they lie. ITK throws.
Result<vtkSmartPointer<vtkDataArray>> read_all_voxels(itk::ImageIOBase& io, std::size_t all_voxels);

/// An image of these voxels, x fastest. Its axes go beside it.
vtkSmartPointer<vtkImageData> make_image_data(const int (&size)[3], const vtkSmartPointer<vtkDataArray>& values, const std::string& name);

}  // namespace catena::vtk
