#include "write/run_folder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "gaussdrift/error.hpp"
#include "write/atomic_file.hpp"
#include "write/output_files.hpp"
#include "write/series_table.hpp"

namespace gaussdrift::write {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view pictures_folder = "images", pictures_ending = ".png";

/// The files that a run writes at the top of its folder.
std::vector<std::string> run_files() {
  std::vector<std::string> names{"case.toml",         "log.txt",     "provenance.json", "report.html",
                                 "report.json",       "run.toml",    series_name,       "summary.json",
                                 "summary.png.panel", "summary.png", "view.py"};
  for (const FileKind& kind : output_files()) names.push_back(fmt::format("{}.pvd", kind.about.name));
  return names;
}

/// Folders with the numbered files of a run, and the ending of these.
std::vector<std::pair<std::string_view, std::string_view>> numbered_files() {
  std::vector<std::pair<std::string_view, std::string_view>> folders{{pictures_folder, pictures_ending}};
  for (const FileKind& kind : output_files()) folders.emplace_back(kind.about.name, kind.ending);
  return folders;
}

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
    for (const auto& [name, ending] : numbered_files()) {
      if (!fs::is_directory(folder / name)) continue;
      for (const auto& entry : fs::directory_iterator(folder / name))
        if (is_numbered(entry.path().filename().string(), ending)) fs::remove(entry.path());
      if (fs::is_empty(folder / name)) fs::remove(folder / name);
    }
    for (const std::string& name : run_files()) {
      fs::remove(folder / name);
      fs::remove(folder / (name + ".part"));  // where a run was killed
    }
  } catch (const fs::filesystem_error& failure) {
    throw FileError(fmt::format("the earlier run in {} cannot be removed: {}; choose another folder with --out",
                                folder.string(), failure.code().message()));
  }
}

std::string view_script(const Case& spec) {
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
  bool first = true;  // the others are read and hidden
  for (const FileKind& kind : output_files()) {
    if (std::none_of(spec.output.files.begin(), spec.output.files.end(),
                     [&](const OutputFile& file) { return file.name == kind.about.name; }))
      continue;
    script += fmt::format("{0} = PVDReader(registrationName='{0}', FileName=os.path.join(here, '{0}.pvd'))\n",
                          kind.about.name);
    script += first ? kind.view(spec.domain.dimension) : fmt::format("Hide({}, view)\n", kind.about.name);
    first = false;
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

void write_run_inputs(const fs::path& folder, const Case& spec, const std::string& resolved) {
  if (!spec.source.empty()) write_text(folder / "case.toml", spec.source);
  write_text(folder / "run.toml", resolved);
  write_text(folder / "view.py", view_script(spec));
}

}  // namespace gaussdrift::write
