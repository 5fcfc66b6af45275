#include "report/summary_picture.hpp"

#include <fmt/format.h>

#include <vector>

#include "gaussdrift/error.hpp"
#include "read/written_run.hpp"
#include "render/panel.hpp"
#include "render/picture.hpp"
#include "report/html.hpp"
#include "report/track_paths.hpp"
#include "write/output_files.hpp"

namespace gaussdrift::report {

namespace fs = std::filesystem;

namespace {

/// Initial, final, exact and error densities, and tracks; `notes`: why some or all are missing.
std::vector<render::Panel> panels_of(const fs::path& folder, const json& summary, std::vector<std::string>& notes) {
  std::vector<render::Panel> panels;
  const auto outputs = read::written_outputs(folder, write::density_output().about.name);
  if (outputs.empty()) {
    notes.push_back("pictures: the run wrote no density files (output.vtk)");
    return panels;
  }
  const json& frames = summary.at("frames");
  const auto add = [&](const read::WrittenOutput& output, const char* array, const char* title, bool error) {
    const json date = output.number < frames.size() ? get(frames[output.number], "date") : json();
    panels.push_back({.title = title,
                      .density = read::read_density(output.file, array),
                      .time = output.time,
                      .date = date.is_string() ? date.get<std::string>() : "",
                      .is_error = error});
  };
  if (outputs.size() > 1) add(outputs.front(), "rho", "initial", false);
  add(outputs.back(), "rho", outputs.size() > 1 ? "final" : "density", false);
  if (std::vector<render::PlaneLine> lines = track_paths(folder); !lines.empty()) {
    add(outputs.back(), "rho", panels.back().density.lattice.dimension == 2 ? "tracks" : "tracks, along z", false);
    panels.back().lines = std::move(lines);
  }
  const json frame = summary.at("frames").empty() ? json::object() : summary.at("frames").back();
  const std::size_t points = panels.back().density.lattice.size();
  const json told = get(frame, "compared");
  const double compared = told.is_number() ? told.get<double>() : static_cast<double>(points);
  if (!frame.contains("Linf")) {
    notes.push_back("pictures of the exact density and the error: the density was compared with nothing");
  } else if (compared < static_cast<double>(points)) {
    notes.push_back(fmt::format(
        "pictures of the exact density and the error: only {:.0f} of the {} grid points were compared with it "
        "(output.images = [\"error\"] compares all, reference.points sets how many)",
        compared, points));
  } else {
    try {
      add(outputs.back(), "rho_exact", "exact", false);
      add(outputs.back(), "error", "error", true);
    } catch (const FileError& error) {
      notes.push_back(fmt::format("pictures of the exact density and the error: {}", error.what()));
    }
  }
  return panels;
}

}  // namespace

void draw_summary(const fs::path& folder, const json& summary, ReportFiles& result) {
  const fs::path file = folder / summary_picture;
  if (const std::string reason = render::unavailable_reason(); !reason.empty()) {
    result.left_out.push_back("pictures: " + reason);
    return;
  }
  std::vector<render::Panel> panels;
  try {
    panels = panels_of(folder, summary, result.left_out);
  } catch (const Error& error) {  // densities that cannot be read
    result.left_out.push_back(fmt::format("pictures: {}", error.what()));
    return;
  }
  if (panels.empty()) return;
  try {
    render::draw_panels(panels, file);
    result.written.push_back(file);
  } catch (const Error& error) {
    result.failed.push_back(error.what());
  }
}

}  // namespace gaussdrift::report
