// SPDX-License-Identifier: MIT
// Collects the errors of the libraries: VTK writes them to an output window, ITK throws exceptions.
#include <vtkObjectFactory.h>
#include <vtkOutputWindow.h>

#include "engine/base/text.h"
#include "engine/io/vtk/open.h"

namespace catena::vtk {
namespace {

std::string first_error;

/// Returns WHAT from "ERROR: In FILE, line N\nCLASS (ADDRESS): WHAT".
std::string error_text(const std::string& text) {
  const std::size_t at = text.find("): ");
  const std::string what = strip_addresses(one_line(at == std::string::npos ? text : text.substr(at + 3)));
  const std::size_t end = what.find_last_not_of(" .\n");
  constexpr std::size_t kMaxErrorBytes = 200;
  return what.substr(0, std::min(end == std::string::npos ? 0 : end + 1, kMaxErrorBytes));
}

class Listener : public vtkOutputWindow {
 public:
  vtkTypeMacro(Listener, vtkOutputWindow);
  static Listener* New();
  void DisplayText(const char*) override {}
  void DisplayErrorText(const char* text) override {
    if (first_error.empty() && text != nullptr) first_error = error_text(text);
  }
};
vtkStandardNewMacro(Listener);

}  // namespace

std::string take_reader_errors() { return std::exchange(first_error, {}); }

void capture_reader_errors() {
  const vtkSmartPointer<Listener> listener = vtkSmartPointer<Listener>::New();
  vtkOutputWindow::SetInstance(listener);
}

}  // namespace catena::vtk
