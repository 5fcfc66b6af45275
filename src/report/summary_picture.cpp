#include "report/summary_picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "gaussdrift/error.hpp"
#include "read/written_run.hpp"
#include "render/panel.hpp"
#include "render/picture.hpp"
#include "render/solid.hpp"
#include "report/html.hpp"
#include "report/player.hpp"
#include "report/sections.hpp"
#include "report/track_paths.hpp"
#include "write/output_files.hpp"

namespace gaussdrift::report {

namespace fs = std::filesystem;

namespace {

/// The outputs whose densities can be drawn: those of the density files, else those that the page plays.
class Outputs {
 public:
  explicit Outputs(const fs::path& folder) : files_(read::written_outputs(folder, write::density_output().about.name)) {
    if (files_.empty()) reel_ = kept_reel(folder);
  }
  std::size_t size() const { return reel_ ? reel_->frames().size() : files_.size(); }
  std::optional<double> time(std::size_t i) const { return reel_ ? reel_->frames()[i].time : files_[i].time; }
  std::string date(std::size_t i, const json& summary) const {
    const std::size_t number = reel_ ? reel_->frames()[i].output : files_[i].number;
    const json& frames = summary.at("frames");
    const json date = number < frames.size() ? get(frames[number], "date") : json();
    return date.is_string() ? date.get<std::string>() : "";
  }
  /// Throws FileError: it is not there.
  DensityGrid density(std::size_t i, const std::string& array) const {
    if (!reel_) return read::read_density(files_[i].file, array);
    const ReelFrame& frame = reel_->frames()[i];
    if (array != "rho_exact") return reel_->density(frame, array);
    DensityGrid exact = reel_->density(frame, "rho");
    const DensityGrid error = reel_->density(frame, "error");
    for (std::size_t k = 0; k < exact.rho.size(); ++k) exact.rho[k] -= error.rho[k];
    return exact;
  }

 private:
  std::vector<read::WrittenOutput> files_;
  std::optional<Reel> reel_;
};

double largest_size(const DensityGrid& density) {
  double most = 0;
  for (const double value : density.rho)
    if (std::isfinite(value)) most = std::max(most, std::abs(value));
  return most;
}

using Box = std::array<std::pair<std::size_t, std::size_t>, 3>;  // first and last index on each axis

Box place_of_all(const Lattice& lattice) {
  Box box;
  for (std::size_t k = 0; k < 3; ++k) box[k] = {0, lattice.points[k] - 1};
  return box;
}

/// Where one of the densities reaches a hundredth of its largest value, with a margin. All of the grid where that is
/// most of it.
Box place_of_something(const std::vector<render::Panel>& panels) {
  const Lattice& lattice = panels.front().density.lattice;
  Box box;
  for (std::size_t k = 0; k < 3; ++k) box[k] = {lattice.points[k] - 1, 0};
  for (const render::Panel& panel : panels) {
    if (panel.quantity != panels.front().quantity || panel.density.lattice.points != lattice.points) continue;
    const double least = 0.01 * largest_size(panel.density);
    for (std::size_t i = 0; least > 0 && i < panel.density.rho.size(); ++i) {
      if (!(std::abs(panel.density.rho[i]) >= least)) continue;
      const std::array at{i % lattice.points[0], i / lattice.points[0] % lattice.points[1],
                          i / lattice.points[0] / lattice.points[1]};
      for (std::size_t k = 0; k < 3; ++k) box[k] = {std::min(box[k].first, at[k]), std::max(box[k].second, at[k])};
    }
  }
  std::size_t longest = 0;
  for (const auto& [first, last] : box) {
    if (first > last) return place_of_all(lattice);
    longest = std::max(longest, last - first + 1);
  }
  double part = 1;
  for (std::size_t k = 0; k < 3; ++k) {
    auto& [first, last] = box[k];
    const std::size_t length = last - first + 1, least = longest * 6 / 10;  // what is slender leaves a panel empty
    const std::size_t margin = std::max(length, least) / 8 + 1 + (least > length ? (least - length) / 2 : 0);
    first -= std::min(first, margin);
    last = std::min(last + margin, lattice.points[k] - 1);
    part *= static_cast<double>(last - first + 1) / static_cast<double>(lattice.points[k]);
  }
  constexpr double most = 0.7;
  return part > most ? place_of_all(lattice) : box;
}

DensityGrid cropped(const DensityGrid& density, const Box& box) {
  const auto& points = density.lattice.points;
  DensityGrid part{.lattice = density.lattice, .rho = {}};
  for (std::size_t k = 0; k < 3; ++k) {
    part.lattice.points[k] = box[k].second - box[k].first + 1;
    part.lattice.origin[k] = density.lattice.coordinate(static_cast<int>(k), box[k].first);
  }
  part.rho.reserve(part.lattice.size());
  for (std::size_t z = box[2].first; z <= box[2].second; ++z)
    for (std::size_t y = box[1].first; y <= box[1].second; ++y)
      for (std::size_t x = box[0].first; x <= box[0].second; ++x)
        part.rho.push_back(density.rho[(z * points[1] + y) * points[0] + x]);
  return part;
}

/// "x from 0.2 to 0.8, y from -0.3 to 0.3"
std::string place_text(const Lattice& lattice, const Box& box) {
  std::string text;
  for (int k = 0; k < lattice.dimension; ++k) {
    const auto [first, last] = box[static_cast<std::size_t>(k)];
    text += fmt::format("{}{} from {:.3g} to {:.3g}", text.empty() ? "" : ", ", "xyz"[k], lattice.coordinate(k, first),
                        lattice.coordinate(k, last));
  }
  return text;
}

/// Zooms to where something is. Returns what to say of it; empty: all is shown.
std::string zoom(std::vector<render::Panel>& panels) {
  const Lattice lattice = panels.front().density.lattice;
  for (const render::Panel& panel : panels)
    if (!panel.lines.empty()) return "";  // they may lead anywhere
  const Box box = place_of_something(panels);
  if (box == place_of_all(lattice)) return "";
  for (render::Panel& panel : panels)
    if (panel.density.lattice.points == lattice.points) panel.density = cropped(panel.density, box);
  return "The pictures show the part of the domain where something is: " + place_text(lattice, box) + ".";
}

/// In space those of the last output are cut by the same planes.
void share_planes(std::vector<render::Panel>& panels, std::size_t first, const render::Panel& last) {
  if (last.density.lattice.dimension != 3) return;
  const auto planes = render::largest_point(last.density);
  for (std::size_t i = first; i < panels.size(); ++i) panels[i].planes = planes;
}

/// The exact density and the error of the last output; `notes`: why they are missing.
void add_comparison(const Outputs& outputs, const json& summary, const json& frame, const std::string& label,
                    std::vector<render::Panel>& panels, std::vector<std::string>& notes) {
  const std::size_t points = panels.back().density.lattice.size(), last = outputs.size() - 1;
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
      const auto add = [&](const char* array, const char* title, const std::string& quantity, bool is_difference) {
        panels.push_back({title, outputs.density(last, array), outputs.time(last), outputs.date(last, summary),
                          quantity, is_difference});
      };
      add("rho_exact", "exact", label, false);
      add("error", "error", "error", true);
    } catch (const FileError& error) {
      notes.push_back(fmt::format("pictures of the exact density and the error: {}", error.what()));
    }
  }
}

/// Initial, middle, final, exact and error densities, and the change from the first to the last. `notes`: why some or
/// all are missing.
std::vector<render::Panel> panels_of(const fs::path& folder, const json& summary, std::vector<std::string>& notes) {
  std::vector<render::Panel> panels;
  const Outputs outputs(folder);
  if (outputs.size() == 0) {
    notes.push_back("pictures: the run wrote no density files (output.vtk), and its page has no frames");
    return panels;
  }
  const std::string label = label_of(summary);
  const std::size_t last = outputs.size() - 1;
  const auto add = [&](std::size_t i, const char* title) {
    panels.push_back({title, outputs.density(i, "rho"), outputs.time(i), outputs.date(i, summary), label, false});
  };
  if (last > 0) add(0, "initial");
  if (last > 1) add(last / 2, "in the middle");
  const std::size_t first_of_last = panels.size();
  add(last, last > 0 ? "final" : label.c_str());
  if (std::vector<render::PlaneLine> lines = track_paths(folder); !lines.empty()) {
    add(last, panels.back().density.lattice.dimension == 2 ? "tracks" : "tracks, along z");
    panels.back().lines = std::move(lines);
  }
  add_comparison(outputs, summary, summary.at("frames").empty() ? json::object() : summary.at("frames").back(), label,
                 panels, notes);
  if (const DensityGrid& begin = panels.front().density, &end = panels[first_of_last].density;
      last > 0 && begin.lattice.points == end.lattice.points) {
    DensityGrid change = end;
    for (std::size_t i = 0; i < change.rho.size(); ++i) change.rho[i] -= begin.rho[i];
    constexpr double rounding = 1e-9;  // what is below is not seen for a change
    if (largest_size(change) <= rounding * largest_size(end)) return panels;
    panels.push_back(
        {"final less initial", std::move(change), outputs.time(last), outputs.date(last, summary), "change", true});
  }
  return panels;
}

/// What falls well below 0 has white in the middle, at 0.
void mark_signed(std::vector<render::Panel>& panels) {
  double low = 0, high = 0;
  for (const render::Panel& panel : panels)
    if (!panel.is_difference)
      for (const double value : panel.density.rho)
        if (std::isfinite(value)) low = std::min(low, value), high = std::max(high, value);
  if (!render::has_both_signs(low, high)) return;
  for (render::Panel& panel : panels) panel.is_difference = true;
}

}  // namespace

std::string draw_summary(const fs::path& folder, const json& summary, ReportFiles& result) {
  const fs::path file = folder / summary_picture;
  if (const std::string reason = render::unavailable_reason(); !reason.empty()) {
    result.left_out.push_back("pictures: " + reason);
    return "";
  }
  std::vector<render::Panel> panels;
  try {
    panels = panels_of(folder, summary, result.left_out);
  } catch (const Error& error) {  // densities that cannot be read
    result.left_out.push_back(fmt::format("pictures: {}", error.what()));
    return "";
  }
  if (panels.empty()) return "";
  mark_signed(panels);
  const std::string zoomed = zoom(panels);
  const auto last = std::find_if(panels.begin(), panels.end(), [&](const render::Panel& panel) {
    return panel.title != "initial" && panel.title != "in the middle";
  });
  share_planes(panels, static_cast<std::size_t>(last - panels.begin()), *last);
  try {
    render::draw_panels(panels, file);
    result.written.push_back(file);
  } catch (const Error& error) {
    result.failed.push_back(error.what());
  }
  return zoomed;
}

}  // namespace gaussdrift::report
