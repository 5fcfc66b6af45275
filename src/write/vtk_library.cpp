#include "write/vtk_library.hpp"

#include <vtkLogger.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkOutputWindow.h>
#include <vtkVersion.h>

#include <cstdlib>

namespace gaussdrift::write {

namespace {

class SilentWindow : public vtkOutputWindow {
 public:
  static SilentWindow* New() { VTK_STANDARD_NEW_BODY(SilentWindow); }
  void DisplayText(const char* /*text*/) override {}
};

}  // namespace

std::string vtk_version() { return vtkVersion::GetVTKVersion(); }

void prepare_vtk() {
  vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF);
  vtkNew<SilentWindow> window;
  vtkOutputWindow::SetInstance(window);
  setenv("VTK_SMP_BACKEND_IN_USE", "Sequential", 0);  // VTK looks at it before its first loop
}

}  // namespace gaussdrift::write
