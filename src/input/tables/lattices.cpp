// Lattices that a case asks for: their sizes and what rounding leaves of them.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "gaussdrift/lattice.hpp"
#include "input/tables/tables.hpp"

namespace gaussdrift::input {

/// Only for numbers that passed their range; larger ones have been complained about.
int to_int(const Number& count) {
  return static_cast<int>(std::min<double>(count.number, std::numeric_limits<int>::max()));
}

std::optional<Number> per_axis(Reader& in, std::string_view table_name, std::string_view why_not_one) {
  const Entry* entry = in.find(table_name, "per_axis");
  const Key& key = find_key(table_name, "per_axis");
  return in.number(table_name, "per_axis", entry ? fmt::format("{}; {}", meaning_note(key), why_not_one) : "");
}

/// Complains about a spacing that coordinates of the domain cannot show.
bool lost_to_rounding(Reader& in, const std::string& what, const Domain& domain, double spacing, const Place& place,
                      const std::string& remedy) {
  double farthest = 0;
  for (std::size_t k = 0; k < static_cast<std::size_t>(domain.dimension); ++k)
    farthest = std::max({farthest, std::abs(domain.min[k]), std::abs(domain.max[k])});
  if (farthest + spacing / 8 != farthest) return false;
  in.diagnostics.error(
      place,
      fmt::format("the spacing {:.3g} of the {} is lost to rounding at coordinates like {}", spacing, what, farthest),
      "move the domain towards the origin, or " + remedy);
  return true;
}

/// The lattice, or nothing (with a complaint) if it has too many points; it is not allocated.
std::optional<Lattice> make_checked_lattice(Reader& in, const std::string& what, const Domain& domain,
                                            const Number& count, double most_points) {
  if (!in.facts.domain_valid) return std::nullopt;
  const Place place = count.written ? count.written->place : in.source.end();
  if (count.number > largest_lattice - 1) {
    in.diagnostics.error(place,
                         fmt::format("the {} would have {} points on one axis; at most {:.0f} are possible", what,
                                     count.number, largest_lattice - 1),
                         "lower per_axis");
    return std::nullopt;
  }
  const Lattice lattice = make_lattice(domain.dimension, domain.min, domain.max, to_int(count));
  double size = 1;
  std::vector<std::size_t> points;
  for (std::size_t k = 0; k < static_cast<std::size_t>(domain.dimension); ++k) {
    points.push_back(lattice.points[k]);
    size *= static_cast<double>(lattice.points[k]);
  }
  if (size > most_points) {
    in.diagnostics.error(place,
                         fmt::format("the {} would have {:.3g} points ({}); at most {:.0f} are possible", what, size,
                                     fmt::join(points, " x "), most_points),
                         "lower per_axis");
    return std::nullopt;
  }
  if (lost_to_rounding(in, what, domain, lattice.spacing, place, "lower per_axis")) return std::nullopt;
  return lattice;
}

bool is_in_domain(const Reader& in, const double* place) {
  for (int k = 0; k < in.facts.dimension; ++k) {
    const auto axis = static_cast<std::size_t>(k);
    if (!(place[axis] >= in.facts.box.min[axis] && place[axis] <= in.facts.box.max[axis])) return false;
  }
  return true;
}

}  // namespace gaussdrift::input
