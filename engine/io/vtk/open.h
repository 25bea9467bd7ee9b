/// A file as the readers of VTK, ITK and their kin see it: blocks of data, each with its arrays, before anything is made of them.
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

struct Block {
  vtkSmartPointer<vtkDataSet> data;
  std::optional<field::Mapping> mapping;  ///< of an image whose axes VTK cannot say; empty: the image's own
};

struct ImportedData {
  std::vector<Block> blocks;                 ///< none is empty
  std::map<std::string, std::string> units;  ///< of arrays, by name
  std::string unit_length;
  bool is_patient_space = false;
  std::vector<double> times;
  std::string time_unit;           ///< of `times`; empty: not stated
  std::vector<std::string> notes;  ///< what is not as it was in the file: sentences without an end

  // of a folder of several volumes (DICOM)
  std::vector<field::GridMetadata> grid_metadata;  ///< of all volumes by each of their names, opened or not
  std::vector<std::function<Result<ImportedData>()>>
      deferred_volumes;             ///< volumes in the order of their numbers, opened when they are described
  std::string name, volume_number;  ///< of one volume
  int image_count = 0;              ///< that it was made of; 0: not counted
  std::string problem;              ///< why it is no field, and there are no blocks: a sentence; empty: it is one
};

/// What is to be read. `shown` begins every message; `path` is where the file lies for this process.
struct Source {
  std::string display_name, path;
  std::string grid;  ///< of formats that hold several images: the one wanted; empty: all; of DICOM the largest
  int step = 0;
  bool axes_xyz = false;
  std::string original_folder;                   ///< where `path` lies, as other processes call it: absolute names in a file begin with it
  field::ReadMode mode = field::ReadMode::load;  ///< DICOM opens no more than is asked for
};

/// One function a family of formats. Errors are whole sentences.
Result<ImportedData> open_with_vtk(const Source& source);
Result<ImportedData> open_with_itk(const Source& source);
/// "DICM" after the preamble.
bool is_dicom_file(const std::string& path);
/// A DICOM file, or a folder of them.
Result<ImportedData> open_dicom(const Source& source);
Result<ImportedData> open_npz(const Source& source);
Result<ImportedData> open_gifti(const Source& source);
Result<ImportedData> open_ply(const Source& source);
/// An OpenFOAM case, by its folder or a file NAME.foam in it, which may be empty: all regions; of one that is decomposed only, all pieces.
Result<ImportedData> open_foam(const Source& source);
/// A file of the names and times of others: .pvd, .series.
Result<ImportedData> open_collection(const Source& source);

/// By its ending, or because it is a folder.
Result<ImportedData> open_any(const Source& source);

/// What VTK's readers told since the last call, as one phrase; empty: nothing.
std::string take_reader_errors();
/// From now on nothing that VTK or ITK tells reaches the terminal.
void capture_reader_errors();

}  // namespace catena::vtk
