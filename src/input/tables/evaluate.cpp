// [evaluate]: the lattice on which density is summed.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "fgtd/fgtd.hpp"
#include "input/tables/tables.hpp"

namespace gaussdrift::input {

namespace {

/// The names of the methods that sum the Gauss transform.
std::vector<std::string_view> summation_methods() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> list;
    for (const fgtd::Method method : fgtd::methods()) list.push_back(fgtd::to_string(method));
    return list;
  }();
  return {names.begin(), names.end()};
}

}  // namespace

Section evaluate_section() {
  std::string methods = "algorithm that sums the Gauss transform";
  for (const fgtd::Method method : fgtd::methods())
    methods += fmt::format(". `{}`: {}", to_string(method), meaning(method));
  return {
      Table{.name = "evaluate", .required = false, .meaning = "the lattice on which the density is summed for output"},
      {{.name = "per_axis",
        .type = Type::whole,
        .fallback = "200",
        .range = {2, infinity},
        .symbol = "n_ge",
        .meaning = "number of evaluation points along the longest axis. The spacing is the same on all axes"},
       {.name = "spacing",
        .type = Type::number,
        .range = {0, infinity, true},
        .unit = "length",
        .symbol = "h_e",
        .meaning =
            "distance between evaluation points on all axes. It replaces `per_axis` and suits long, narrow domains"},
       {.name = "tolerance",
        .type = Type::number,
        .fallback = "1e-08",
        .range = {1e-14, 1, false, true},
        .meaning = "error allowed in the Gauss transform, relative to the largest density at that output"},
       {.name = "method", .type = Type::choice, .fallback = "auto", .choices = summation_methods(), .meaning = methods},
       {.name = "r",
        .type = Type::number,
        .fallback = "0.5",
        .range = {0, 1, true, true},
        .symbol = "r",
        .meaning =
            "for `method = \"hermite\"`, by hand: boxes have the side r sqrt(2/sigma). With `r`, `p` or `n` their "
            "bound takes the place of the tolerance"},
       {.name = "p",
        .type = Type::whole,
        .fallback = "9",
        .range = {1, 1000},
        .symbol = "p",
        .meaning = "for `method = \"hermite\"`, by hand: terms of the series on each axis"},
       {.name = "n",
        .type = Type::whole,
        .range = {0, 1000000},
        .symbol = "n",
        .meaning = "for `method = \"hermite\"`, by hand: boxes to each side, on each axis, whose particles count. "
                   "Without this key all"},
       {.name = "most_seconds",
        .type = Type::number,
        .range = {0, infinity, true},
        .unit = "s",
        .meaning = "most seconds that one density may be predicted to take; a case that takes longer is refused before "
                   "its first step. Without this key 300 for a method that is named, and no limit for `auto`"},
       {.name = "tile_particles",
        .type = Type::whole,
        .range = {1, infinity},
        .meaning = "most particles of a tile: a density with more is summed part by part. Smaller tiles take less "
                   "memory, and more ranks can share them. Without this key 262144 in the plane and 1048576 in space"},
       {.name = "piece_points",
        .type = Type::whole,
        .fallback = "33554432",
        .range = {1000, 134217728},
        .meaning = "most points of a grid that is held as a whole. A larger one is summed and written in pieces, none "
                   "of which "
                   "has more points. Smaller pieces take less memory"}}};
}

namespace {

/// A handful of points across a long domain shows nothing of what is there.
void warn_narrow(Reader& in, const Lattice& lattice, const Domain& domain, const Place& place) {
  const auto dimension = static_cast<std::size_t>(lattice.dimension);
  const auto begin = lattice.points.begin(), end = begin + lattice.dimension;
  const auto fewest = static_cast<std::size_t>(std::min_element(begin, end) - begin);
  const std::size_t most = *std::max_element(begin, end);
  if (lattice.points[fewest] >= 8 || most < 10 * lattice.points[fewest]) return;
  if (in.facts.one_particle_across[fewest]) return;  // then there is nothing to show
  const double spacing = (domain.max[fewest] - domain.min[fewest]) / 20;
  std::vector<std::size_t> now, then;
  double size = 1;
  for (std::size_t k = 0; k < dimension; ++k) {
    now.push_back(lattice.points[k]);
    then.push_back(static_cast<std::size_t>((domain.max[k] - domain.min[k]) / spacing * (1 + 1e-12)) + 1);
    size *= static_cast<double>(then.back());
  }
  in.diagnostics.warning(place,
                         fmt::format("the evaluation lattice has {} points, only {} along {}", fmt::join(now, " x "),
                                     lattice.points[fewest], "xyz"[fewest]),
                         size <= 1e7 ? fmt::format("[evaluate] spacing = {:.3g} instead of per_axis has {} points",
                                                   spacing, fmt::join(then, " x "))
                                     : "raise evaluate.per_axis, or give evaluate.spacing instead");
}

void read_spacing(Reader& in, EvaluateSpec& evaluate, const Domain& domain) {
  const auto spacing = in.number("evaluate", "spacing");
  if (!spacing || !in.facts.domain_valid) return;
  const Place& place = spacing->written->place;
  double longest = 0, size = 1;
  for (std::size_t k = 0; k < static_cast<std::size_t>(domain.dimension); ++k) {
    longest = std::max(longest, domain.max[k] - domain.min[k]);
    size *= std::floor((domain.max[k] - domain.min[k]) / spacing->number) + 1;
  }
  if (spacing->number > longest)
    in.diagnostics.error(place,
                         fmt::format("evaluate.spacing = {} is longer than the domain, {}", spacing->number, longest),
                         "a lattice has at least two points on the longest axis");
  else if (!(size <= largest_grid))
    in.diagnostics.error(place,
                         fmt::format("the evaluation lattice would have {:.3g} points; at most {} are possible", size,
                                     static_cast<long long>(largest_grid)),
                         "raise evaluate.spacing");
  else if (lost_to_rounding(in, "evaluation lattice", domain, spacing->number, place, "raise evaluate.spacing"))
    return;
  else
    evaluate.spacing = spacing->number;
}

}  // namespace

namespace {

void read_by_hand(Reader& in, EvaluateSpec& evaluate) {
  const Entry* given = nullptr;
  for (const char* key : {"r", "p", "n"})
    if (const Entry* entry = in.find("evaluate", key); entry && !given) given = entry;
  if (!given) return;
  if (evaluate.method != to_string(fgtd::Method::hermite)) {
    in.diagnostics.error(
        given->place, fmt::format("evaluate.r, p and n go with method = \"hermite\", not with \"{}\"", evaluate.method),
        "write method = \"hermite\", or leave them out: a tolerance is enough");
    return;
  }
  HermiteSpec& by_hand = evaluate.hermite.emplace();
  if (const auto r = in.number("evaluate", "r")) by_hand.r = r->number;
  if (const auto p = in.number("evaluate", "p")) by_hand.p = to_int(*p);
  if (const auto n = in.number("evaluate", "n")) by_hand.n = to_int(*n);
}

}  // namespace

void read_evaluate(Reader& in, EvaluateSpec& evaluate, const Domain& domain) {
  const Entry *spacing = in.find("evaluate", "spacing"), *points = in.find("evaluate", "per_axis");
  if (spacing && points &&
      spacing->place.override_index != points->place.override_index)  // the later one replaces the other
    (spacing->place.override_index > points->place.override_index ? points : spacing) = nullptr;
  if (spacing && points)
    in.exactly_one("evaluate", {"per_axis", "spacing"});
  else if (spacing)
    read_spacing(in, evaluate, domain);
  else if (const auto count = per_axis(in, "evaluate", "a lattice has at least two points an axis")) {
    if (const auto lattice = make_checked_lattice(in, "evaluation lattice", domain, *count, largest_grid))
      warn_narrow(in, *lattice, domain, count->written ? count->written->place : in.source.end());
    evaluate.per_axis = to_int(*count);
  }
  if (const auto tolerance = in.number("evaluate", "tolerance")) evaluate.tolerance = tolerance->number;
  evaluate.method = in.choice("evaluate", "method");
  read_by_hand(in, evaluate);
  if (const auto most = in.number("evaluate", "most_seconds")) evaluate.most_seconds = most->number;
  if (const auto most = in.number("evaluate", "tile_particles")) evaluate.tile_particles = most->number;
  if (const auto most = in.number("evaluate", "piece_points")) evaluate.piece_points = most->number;
}

void write_evaluate(Writer& out, const EvaluateSpec& evaluate) {
  out.table("evaluate");
  if (evaluate.spacing > 0)
    out.entry("spacing", written(evaluate.spacing));
  else
    out.entry("per_axis", fmt::format("{}", evaluate.per_axis));
  out.entry("tolerance", written(evaluate.tolerance));
  out.entry("method", written(evaluate.method));
  if (evaluate.hermite) {
    out.entry("r", written(evaluate.hermite->r));
    out.entry("p", fmt::format("{}", evaluate.hermite->p));
    if (evaluate.hermite->n >= 0) out.entry("n", fmt::format("{}", evaluate.hermite->n));
  }
  if (evaluate.most_seconds > 0) out.entry("most_seconds", written(evaluate.most_seconds));
  if (evaluate.tile_particles > 0) out.entry("tile_particles", fmt::format("{:.0f}", evaluate.tile_particles));
  if (evaluate.piece_points != EvaluateSpec{}.piece_points)
    out.entry("piece_points", fmt::format("{:.0f}", evaluate.piece_points));
}

}  // namespace gaussdrift::input
