// VTK on OSMesa. Stock VTK and GLEW are built for GLX and reach OpenGL in three ways. Each of them is led to OSMesa:
//   direct calls (glClear, ...)   libOSMesa comes first among the libraries of this one, see CMakeLists.txt; checked below
//   GLEW's function pointers      the function glXGetProcAddressARB defined here answers instead of libGLX's
//   glewInit's return code        complains about the missing X display after all pointers are set; accepted here
#include "render/vtk/osmesa_window.hpp"

#include <GL/glew.h>
#ifndef GLAPI
#define GLAPI extern
#endif
#ifndef GLAPIENTRY
#define GLAPIENTRY
#endif
#ifndef APIENTRY
#define APIENTRY GLAPIENTRY
#endif
#include <GL/osmesa.h>
#include <dlfcn.h>
#include <vtkCollection.h>
#include <vtkObjectFactory.h>
#include <vtkOpenGLRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkRendererCollection.h>

#include <array>
#include <cstring>
#include <string>

// GLEW finds this function before libGLX's. It must not know names of GLX: OSMesa would make up a stub for any name that
// begins with gl.
extern "C" {
using Function = void (*)();
__attribute__((visibility("default"), used)) Function glXGetProcAddressARB(const GLubyte* name) {
  const char* text = reinterpret_cast<const char*>(name);
  return std::strncmp(text, "glX", 3) == 0 ? nullptr : OSMesaGetProcAddress(text);
}
}

namespace gaussdrift::render {
namespace {

/// VTK draws into a framebuffer of its own, so the one of the context stays tiny whatever the size of the picture.
constexpr int buffer_side = 16;

class OsmesaWindow : public vtkOpenGLRenderWindow {
 public:
  static OsmesaWindow* New();
  vtkTypeMacro(OsmesaWindow, vtkOpenGLRenderWindow)  // no semicolon

      void Initialize() override {
    if (!context_) CreateAWindow();
    MakeCurrent();
    if (!Initialized) OpenGLInit();
  }
  void MakeCurrent() override {
    if (context_) OSMesaMakeCurrent(context_, buffer_.data(), GL_UNSIGNED_BYTE, buffer_side, buffer_side);
  }
  bool IsCurrent() override { return context_ && OSMesaGetCurrentContext() == context_; }
  void ReleaseCurrent() override { OSMesaMakeCurrent(nullptr, nullptr, GL_UNSIGNED_BYTE, 0, 0); }

  void OpenGLInitContext() override {
    if (Initialized) return;
    ContextCreationTime.Modified();
    const GLenum code = glewInit();
    GlewInitValid = code == GLEW_OK || code == GLEW_ERROR_NO_GLX_DISPLAY || code == GLEW_ERROR_GLX_VERSION_11_ONLY;
    if (!GlewInitValid || !(GLEW_VERSION_3_2 || GLEW_VERSION_3_1)) {
      vtkErrorMacro(<< "OSMesa offers no OpenGL 3.2 (glewInit " << code << ")");
      return;
    }
    Initialized = true;
    std::array<GLfloat, 2> widths{1, 1};
    glGetFloatv(LineSmoothing ? GL_SMOOTH_LINE_WIDTH_RANGE : GL_ALIASED_LINE_WIDTH_RANGE, widths.data());
    MaximumHardwareLineWidth = widths[1];
  }
  void Frame() override {
    MakeCurrent();
    Superclass::Frame();
  }
  void Finalize() override { DestroyWindow(); }

  int SupportsOpenGL() override { return 1; }
  vtkTypeBool IsDirect() override { return 0; }
  vtkTypeBool GetEventPending() override { return 0; }
  int* GetScreenSize() override { return screen_.data(); }

  bool ready() const { return context_ && Initialized; }

 protected:
  OsmesaWindow() {
    FrameBlitMode = NoBlit;
    UseOffScreenBuffers = true;
    ShowWindow = false;
  }
  ~OsmesaWindow() override {
    Finalize();
    Renderers->InitTraversal();
    while (vtkRenderer* renderer = Renderers->GetNextItem()) renderer->SetRenderWindow(nullptr);
  }

  void CreateAWindow() override {
    constexpr std::array<int, 14> attributes{OSMESA_FORMAT,
                                             OSMESA_RGBA,
                                             OSMESA_DEPTH_BITS,
                                             24,
                                             OSMESA_STENCIL_BITS,
                                             8,
                                             OSMESA_PROFILE,
                                             OSMESA_CORE_PROFILE,
                                             OSMESA_CONTEXT_MAJOR_VERSION,
                                             3,
                                             OSMESA_CONTEXT_MINOR_VERSION,
                                             2,
                                             0,
                                             0};
    context_ = OSMesaCreateContextAttribs(attributes.data(), nullptr);
    Mapped = 0;
  }
  void DestroyWindow() override {
    if (!context_) return;
    MakeCurrent();
    ReleaseGraphicsResources(this);
    ReleaseCurrent();
    OSMesaDestroyContext(context_);
    context_ = nullptr;
    Initialized = false;
  }

 private:
  OSMesaContext context_ = nullptr;
  std::array<unsigned char, 4 * buffer_side * buffer_side> buffer_{};
  std::array<int, 2> screen_{16384, 16384};
};
vtkStandardNewMacro(OsmesaWindow)

    /// In the wrong order of libraries every picture would be blank, and the exit status 0. So the order is checked.
    std::string wrong_library() {
  for (const char* name : {"glDrawArrays", "glGetString", "glReadPixels"}) {
    Dl_info info{};
    void* address = dlsym(RTLD_DEFAULT, name);
    if (!address || !dladdr(address, &info) || !info.dli_fname || !std::strstr(info.dli_fname, "libOSMesa"))
      return std::string("pictures cannot be drawn: ") + name + " comes from " +
             (address && info.dli_fname ? info.dli_fname : "no library") +
             " instead of libOSMesa; libOSMesa must be the first library of the one that draws "
             "(src/render/CMakeLists.txt)";
  }
  return {};
}

/// Never destroyed: Mesa cleans up at exit before static objects do, and a window after that would crash.
OsmesaWindow* the_window = nullptr;

}  // namespace

std::string open_window() {
  if (std::string reason = wrong_library(); !reason.empty()) return reason;
  the_window = OsmesaWindow::New();
  the_window->SetMultiSamples(0);  // scene.cpp has a cheaper way
  the_window->AlphaBitPlanesOn();
  the_window->Initialize();
  if (!the_window->ready())
    return "pictures cannot be drawn: OSMesa gives no OpenGL 3.2 context; is libosmesa6 of Mesa 22 installed?";
  the_window->ReleaseCurrent();
  return {};
}

void close_window() { the_window->Finalize(); }

vtkRenderWindow* offscreen_window(int width, int height) {
  the_window->SetSize(width, height);
  return the_window;
}

void release_window() { the_window->ReleaseCurrent(); }

}  // namespace gaussdrift::render
