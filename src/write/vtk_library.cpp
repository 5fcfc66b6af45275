#include "write/vtk_library.hpp"

#include <vtkLogger.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkOutputWindow.h>
#include <vtkVersion.h>

namespace gaussdrift::write {

namespace {

class SilentWindow : public vtkOutputWindow {
 public:
  static SilentWindow* New() { VTK_STANDARD_NEW_BODY(SilentWindow); }
  void DisplayText(const char* /*text*/) override {}
};

}  // namespace

std::string vtk_version() { return vtkVersion::GetVTKVersion(); }

void silence_vtk() {
  vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF);
  vtkNew<SilentWindow> window;
  vtkOutputWindow::SetInstance(window);
}

}  // namespace gaussdrift::write
