#include "render/drawing_library.hpp"

#include <cstdlib>

#include "base/shared_module.hpp"
#include "gaussdrift/error.hpp"
#include "render/short_memory.hpp"

namespace gaussdrift::render {

namespace {

struct Loaded {
  Drawing* drawing = nullptr;
  std::string missing;

#ifdef GAUSSDRIFT_NO_PICTURES
  Loaded() : missing("this program draws no pictures: " GAUSSDRIFT_NO_PICTURES) {}
#else
  Loaded() {
    check_room_for_drawing();
    const WhileDrawing guard;
    const base::SharedModule module({GAUSSDRIFT_DRAWING});
    if (!module.is_there()) {
      missing = "pictures cannot be drawn: " + module.reason() +
                ". They need " GAUSSDRIFT_DRAWING ", which is installed with the program in " GAUSSDRIFT_MODULES
                ", and the libraries of VTK and OSMesa (docs/trouble.md)";
      return;
    }
    drawing = module.find<Drawing*()>("gaussdrift_drawing")();
    missing = drawing->start();
    if (!missing.empty()) return;
    // Mesa cleans up at exit before static objects do. This handler is registered after Mesa's, hence called before it.
    std::atexit([] {
      const WhileDrawing while_finishing;  // what is left of a picture that found no memory may crash here
      only().drawing->finish();
    });
  }
#endif

  /// Never destroyed.
  static Loaded& only() {
    static Loaded* const loaded = new Loaded;
    return *loaded;
  }
};

}  // namespace

std::recursive_mutex& drawing_mutex() {
  static std::recursive_mutex mutex;
  return mutex;
}

const std::string& missing_drawing() { return Loaded::only().missing; }

Drawing& drawing() {
  const Loaded& loaded = Loaded::only();
  if (!loaded.missing.empty()) throw Error(ExitCode::internal, loaded.missing);
  return *loaded.drawing;
}

}  // namespace gaussdrift::render
