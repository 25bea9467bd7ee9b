// SPDX-License-Identifier: MIT
/// A file as read by VTK, ITK and related libraries: blocks of data, each with its arrays, before they are converted to fields.
#pragma once
#include <vtkDataSet.h>
#include <vtkSmartPointer.h>

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "engine/field/mapping.h"
#include "engine/io/protocol.h"

namespace catena::vtk {

/// One data set of a file.
struct Block {
  vtkSmartPointer<vtkDataSet> data;
  std::optional<field::Mapping> mapping;  ///< Mapping of an image whose axes VTK cannot represent; nullopt: the image's own.
};

/// Contents of a file.
struct ImportedData {
  std::vector<Block> blocks;                 ///< No block is empty.
  std::map<std::string, std::string> units;  ///< Units of arrays, by name.
  std::string unit_length;
  bool is_patient_space = false;
  std::vector<double> times;
  std::string time_unit;           ///< Unit of `times`; empty: not specified.
  std::vector<std::string> notes;  ///< Differences between the data and the file: messages without a final period.

  // for a folder of several volumes (DICOM)
  std::vector<field::GridMetadata> grid_metadata;  ///< Metadata of all volumes, by each of their names, whether opened or not.
  std::vector<std::function<Result<ImportedData>()>>
      deferred_volumes;             ///< Volumes in the order of their numbers; each is opened when it is described.
  std::string name, volume_number;  ///< Name and number of one volume.
  int image_count = 0;              ///< Number of images in the volume; 0: not counted.
  std::string problem;  ///< Complete message: the reason that the volume is not a field and has no blocks; empty: it is a field.
};

/// File to read. `display_name` begins every message; `path` is the location of the file in this process.
struct Source {
  std::string display_name, path;
  std::string grid;  ///< Requested image, for formats that hold several; empty: all; for DICOM: the largest.
  int step = 0;
  bool axes_xyz = false;
  std::string original_folder;                   ///< Folder of `path` outside of the sandbox: absolute names in a file begin with it.
  field::ReadMode mode = field::ReadMode::load;  ///< DICOM opens only what the mode needs.
};

// Openers, one per family of formats. Errors have complete messages.

/// Opens VTK's XML files.
Result<ImportedData> open_vtk_xml(const Source& source);
/// Opens VTK's XML files of several blocks; an Error if a block index is too large.
Result<ImportedData> open_vtk_blocks(const Source& source);
Result<ImportedData> open_vtk_legacy(const Source& source);
Result<ImportedData> open_ensight(const Source& source);
Result<ImportedData> open_cgns(const Source& source);
Result<ImportedData> open_netcdf(const Source& source);
Result<ImportedData> open_with_itk(const Source& source);
/// Returns whether the file has "DICM" after the preamble.
bool is_dicom_file(const std::string& path);
/// Opens a DICOM file, or a folder of them.
Result<ImportedData> open_dicom(const Source& source);
Result<ImportedData> open_npz(const Source& source);
Result<ImportedData> open_gifti(const Source& source);
Result<ImportedData> open_ply(const Source& source);
/// Opens an OpenFOAM case, given by its folder or a file NAME.foam in it, which may be empty: all regions; if it is decomposed only: all
/// pieces.
Result<ImportedData> open_foam(const Source& source);
/// Opens a file that lists other files and their times: .pvd, .series.
Result<ImportedData> open_collection(const Source& source);

/// Selects the opener by the file extension (formats.cpp), or because the path is a folder.
Result<ImportedData> open_any(const Source& source);

/// Returns the first error that VTK's readers have reported since the last call, as a message fragment; empty: none.
std::string take_reader_errors();
/// Redirects messages of VTK from the terminal to take_reader_errors(), for the rest of the process.
void capture_reader_errors();

}  // namespace catena::vtk
