/// A file as the readers of VTK, ITK and their kin see it: blocks of data, each with its arrays, before anything is made of them.
#pragma once
#include <vtkDataSet.h>
#include <vtkSmartPointer.h>

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "engine/field/mapping.h"
#include "engine/field/reader_exchange.h"

namespace catena::vtk {

struct Block {
  vtkSmartPointer<vtkDataSet> data;
  std::optional<field::Mapping> mapping;  ///< of an image whose axes VTK cannot say; empty: the image's own
};

struct Opened {
  std::vector<Block> blocks;                 ///< none is empty
  std::map<std::string, std::string> units;  ///< of arrays, by name
  std::string unit_length;
  bool patient = false;
  std::vector<double> times;
  std::vector<std::string> notes;  ///< what is not as it was in the file: sentences without an end
};

/// What is to be read. `shown` begins every message; `path` is where the file lies for this process.
struct Source {
  std::string shown, path;
  std::string grid;  ///< of formats that hold several images: the one wanted; empty: all
  int step = 0;
  bool axes_xyz = false;
};

/// One function a family of formats. Errors are whole sentences.
Result<Opened> open_with_vtk(const Source& source);
Result<Opened> open_with_itk(const Source& source);
Result<Opened> open_dicom_folder(const Source& source);
/// Where more images of a DICOM file's series lie beside it: that the folder opens as a volume, a sentence without an end; else empty.
std::string series_beside(const Source& source);
Result<Opened> open_npz(const Source& source);
Result<Opened> open_gifti(const Source& source);

/// By its ending, or because it is a folder.
Result<Opened> open_any(const Source& source);

/// What VTK's readers told since the last call, as one phrase; empty: nothing.
std::string take_complaint();
/// From now on nothing that VTK or ITK tells reaches the terminal.
void listen_to_complaints();

}  // namespace catena::vtk
