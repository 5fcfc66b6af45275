#include "read/stored_density.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/number.hpp"
#include "gaussdrift/error.hpp"
#include "read/grid_file.hpp"

namespace gaussdrift::read {

namespace fs = std::filesystem;

namespace {

/// Paths of cases are relative to them; these are not.
template <class Read>
auto told(const fs::path& file, const Read& read) {
  try {
    return read();
  } catch (const GridFileError& error) {
    const bool tells = !error.remedy().empty() && fs::exists(file);
    throw FileError(tells ? fmt::format("{}; {}", error.what(), error.remedy()) : std::string(error.what()));
  }
}

struct TimedDensity {
  DensityGrid density;
  std::optional<double> time;
  std::size_t components = 1;
};

TimedDensity read_image(const fs::path& file, const std::string& array, std::optional<std::size_t> component = {}) {
  GridSnapshot data = told(file, [&] { return read_snapshot(file, array, component); });
  DensityGrid density;
  density.lattice.dimension = data.dimension;
  density.lattice.sphere = data.sphere;
  double spacing = 0;  // of the first axis that has one
  for (int k = 0; k < data.dimension && spacing == 0; ++k)
    if (const auto& nodes = data.axis[static_cast<std::size_t>(k)]; nodes.size() > 1) spacing = nodes[1] - nodes[0];
  if (spacing == 0) throw FileError(fmt::format("the grid of {} is a single point", file.string()));
  density.lattice.spacing = spacing;
  for (int k = 0; k < data.dimension; ++k) {
    const auto axis = static_cast<std::size_t>(k);
    const std::vector<double>& nodes = data.axis[axis];
    density.lattice.points[axis] = nodes.size();
    density.lattice.origin[axis] = nodes.front();
    // Coordinates are rounded: origins may be large against spacings.
    const double rounding = 1e-6 * spacing + 1e-15 * std::max(std::abs(nodes.front()), std::abs(nodes.back()));
    for (std::size_t i = 1; i < nodes.size(); ++i)
      if (!(std::abs(nodes[i] - nodes[i - 1] - spacing) <= rounding))
        throw FileError(fmt::format(
            "the grid of {} is not equally spaced, the same on all axes, as densities are: {} between points {} and {} "
            "along {}, {} elsewhere",
            file.string(), base::told_apart(nodes[i] - nodes[i - 1], spacing), i, i + 1, "xyz"[k],
            base::told_apart(spacing, nodes[i] - nodes[i - 1])));
  }
  density.rho = std::move(data.values);
  return {std::move(density), data.time, data.components};
}

}  // namespace

StoredDensity::StoredDensity(fs::path file, std::string array, std::optional<std::size_t> component)
    : file_(std::move(file)), array_(std::move(array)), component_(component) {
  if (file_.extension() == ".pvti") {
    index_ = told(file_, [&] { return read_piece_index(file_); });
    return;
  }
  TimedDensity image = read_image(file_, array_, component_);
  index_.lattice = image.density.lattice;
  const LatticeBox all{{}, image.density.lattice.points};
  index_.pieces.push_back({file_, all, all, 0});
  values_ = std::move(image.density.rho);
  time_ = image.time;
  components_ = image.components;
  held_ = 0;
}

const std::vector<double>& StoredDensity::values(std::size_t piece) {
  if (held_ == piece) return values_;
  held_.reset();
  values_ = {};  // two pieces at once may be too much
  const IndexedPiece& about = index_.pieces[piece];
  if (!fs::exists(about.file))
    throw FileError(
        fmt::format("there is no file {}, which line {} of {} names", about.file.string(), about.line, file_.string()));
  TimedDensity image = read_image(about.file, array_, component_);
  check_fits(piece, image.density);
  values_ = std::move(image.density.rho);
  time_ = image.time;
  components_ = image.components;
  held_ = piece;
  return values_;
}

void StoredDensity::check_fits(std::size_t piece, const DensityGrid& read) const {
  const IndexedPiece& about = index_.pieces[piece];
  bool fits = read.lattice.points == about.shown.points;
  const double spacing = index_.lattice.spacing;
  for (int k = 0; fits && k < index_.lattice.dimension; ++k) {
    const auto axis = static_cast<std::size_t>(k);
    const double from = index_.lattice.coordinate(k, about.shown.first[axis]);
    fits = std::abs(read.lattice.origin[axis] - from) <= 1e-3 * spacing + 1e-12 * std::abs(from);
  }
  fits =
      fits && std::abs(read.lattice.spacing - spacing) <= 1e-6 * spacing + 1e-12 * std::abs(index_.lattice.origin[0]);
  if (!fits)
    throw FileError(fmt::format("the grid of {} is not the one that line {} of {} says", about.file.string(),
                                about.line, file_.string()));
}

std::optional<double> StoredDensity::time() {
  values(0);
  return time_;
}

std::size_t StoredDensity::components() {
  values(0);
  return components_;
}

FieldOnGrid read_vector(const fs::path& file, const std::string& array) {
  FieldOnGrid field{.name = array, .components = 1, .values = {}};
  for (int c = 0; c < field.components; ++c) {
    const DensityGrid one = read_density(file, array, static_cast<std::size_t>(c));
    field.components = one.lattice.dimension;
    const auto components = static_cast<std::size_t>(field.components);
    field.values.resize(one.rho.size() * components);
    for (std::size_t j = 0; j < one.rho.size(); ++j)
      field.values[j * components + static_cast<std::size_t>(c)] = one.rho[j];
  }
  return field;
}

DensityGrid read_density(const fs::path& file, const std::string& array, std::optional<std::size_t> component) {
  if (file.extension() != ".pvti") return read_image(file, array, component).density;
  StoredDensity stored(file, array, component);
  const std::size_t every = thinning(stored.lattice());
  DensityGrid thin{thinned(stored.lattice(), every), {}};
  thin.rho.resize(thin.lattice.size());
  for (std::size_t piece = 0; piece < stored.pieces(); ++piece) {
    const LatticeBox &own = stored.own(piece), &shown = stored.shown(piece);
    const auto first = [&](std::size_t k) { return (own.first[k] + every - 1) / every * every; };
    const std::vector<double>& values = stored.values(piece);
    for (std::size_t l = first(2); l < own.end(2); l += every)
      for (std::size_t j = first(1); j < own.end(1); j += every)
        for (std::size_t i = first(0); i < own.end(0); i += every)
          thin.rho[i / every + thin.lattice.points[0] * (j / every + thin.lattice.points[1] * (l / every))] =
              values[shown.number(i, j, l)];
  }
  return thin;
}

}  // namespace gaussdrift::read
