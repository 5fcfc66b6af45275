#include "write/run_folder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "base/error.hpp"
#include "write/atomic_file.hpp"

namespace gaussdrift::write {

namespace fs = std::filesystem;

namespace {

// The files that a run writes at the top of its folder, and the numbered files below it.
constexpr std::array<std::string_view, 13> run_files{
    "case.toml", "density.pvd", "log.txt",      "particles.pvd",     "provenance.json", "report.html", "report.json",
    "run.toml",  "series.csv",  "summary.json", "summary.png.panel", "summary.png",     "view.py"};
constexpr std::array<std::pair<std::string_view, std::string_view>, 3> numbered_files{
    {{"density", ".vti"}, {"particles", ".vtp"}, {"images", ".png"}}};

// "surface_0012.png": letters, an underscore, digits, and the ending; ".part" where a run was killed.
bool is_numbered(std::string name, std::string_view ending) {
  if (name.ends_with(".part")) name.resize(name.size() - 5);
  if (!name.ends_with(ending)) return false;
  name.resize(name.size() - ending.size());
  const std::size_t underscore = name.rfind('_');
  return underscore != std::string::npos && name.size() - underscore > 4 &&
         std::all_of(name.begin() + static_cast<std::ptrdiff_t>(underscore) + 1, name.end(),
                     [](unsigned char c) { return std::isdigit(c) != 0; });
}

// Removes what a run wrote and nothing else: what a user keeps beside it stays.
void remove_earlier_run(const fs::path& folder) {
  try {
    for (const auto& [name, ending] : numbered_files) {
      if (!fs::is_directory(folder / name)) continue;
      for (const auto& entry : fs::directory_iterator(folder / name))
        if (is_numbered(entry.path().filename().string(), ending)) fs::remove(entry.path());
      if (fs::is_empty(folder / name)) fs::remove(folder / name);
    }
    for (const std::string_view name : run_files) {
      fs::remove(folder / name);
      fs::remove(folder / (std::string(name) + ".part"));  // where a run was killed
    }
  } catch (const fs::filesystem_error& failure) {
    throw FileError(fmt::format("the earlier run in {} cannot be removed: {}; choose another folder with --out",
                                folder.string(), failure.code().message()));
  }
}

std::string view_script(const Case& scene) {
  const auto wants = [&](OutputSpec::Vtk kind) {
    return std::find(scene.output.vtk.begin(), scene.output.vtk.end(), kind) != scene.output.vtk.end();
  };
  std::string script =
      "# Opens this run in ParaView:   paraview --script=view.py   (in this folder), or   pvpython view.py\n"
      "import os\n"
      "\n"
      "from paraview.simple import *\n"
      "\n"
      "try:\n"
      "    here = os.path.dirname(os.path.abspath(__file__))\n"
      "except NameError:  # some versions of ParaView do not say where a script lies\n"
      "    here = os.getcwd()\n"
      "\n"
      "view = GetActiveViewOrCreate('RenderView')\n";
  if (wants(OutputSpec::Vtk::density)) {
    script +=
        "density = PVDReader(registrationName='density', FileName=os.path.join(here, 'density.pvd'))\n"
        "shown = Show(density, view)\n"
        "ColorBy(shown, ('POINTS', 'rho'))\n"
        "shown.RescaleTransferFunctionToDataRange(False, True)\n"
        "shown.SetScalarBarVisibility(view, True)\n";
    script += scene.domain.dimension == 2 ? "shown.SetRepresentationType('Surface')\n"
                                          : "shown.SetRepresentationType('Volume')\n";
  }
  if (wants(OutputSpec::Vtk::particles)) {
    script += "particles = PVDReader(registrationName='particles', FileName=os.path.join(here, 'particles.pvd'))\n";
    script += wants(OutputSpec::Vtk::density) ? "Hide(particles, view)\n" : "Show(particles, view)\n";
  }
  script +=
      "GetAnimationScene().UpdateAnimationUsingDataTimeSteps()\n"
      "ResetCamera(view)\n"
      "Render(view)\n";
  return script;
}

}  // namespace

void prepare_run_folder(const fs::path& folder, bool force) {
  std::error_code problem;
  const auto refuse = [&](const std::string& what) {
    throw FileError(
        fmt::format("cannot use {} as output folder: {}; choose another folder with --out", folder.string(), what));
  };
  const fs::file_status status = fs::status(folder, problem);
  if (fs::exists(status) && !fs::is_directory(status)) refuse("it is a file");
  if (fs::exists(status)) {
    const bool empty = fs::is_empty(folder, problem);
    if (problem) refuse(problem.message());
    if (!empty && !force)
      throw FileError(fmt::format("{} is not empty; --force replaces the earlier run in it, --out DIR writes elsewhere",
                                  folder.string()));
    if (!empty && !fs::exists(folder / "run.toml"))
      throw FileError(
          fmt::format("{} holds no earlier run (it has no run.toml), so --force does not touch it; choose "
                      "another folder with --out",
                      folder.string()));
    if (!empty) remove_earlier_run(folder);
  } else {
    fs::create_directories(folder, problem);
    if (problem) refuse(problem.message());
  }
  // A folder that cannot be written is found out now and not after the first hour of stepping.
  write_text(folder / "run.toml", "# this run has not begun\n");
}

void write_run_inputs(const fs::path& folder, const Case& scene, const std::string& resolved) {
  if (!scene.source.empty()) write_text(folder / "case.toml", scene.source);
  write_text(folder / "run.toml", resolved);
  write_text(folder / "view.py", view_script(scene));
}

}  // namespace gaussdrift::write
