// [domain]: the box.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "input/tables/tables.hpp"

namespace gaussdrift::input {

namespace {

constexpr std::string_view longitude_latitude = "longitude latitude";

}  // namespace

Section domain_section() {
  return {Table{.name = "domain",
                .required = true,
                .meaning = "the box in which particles start and on which the density is evaluated"},
          {{.name = "min",
            .type = Type::numbers,
            .required = true,
            .unit = "length",
            .meaning = "lower corner: 2 numbers in 2D, 3 numbers in 3D"},
           {.name = "max",
            .type = Type::numbers,
            .required = true,
            .unit = "length",
            .meaning = "upper corner. It lies above `min` on every axis"},
           {.name = "coordinates",
            .type = Type::choice,
            .choices = {longitude_latitude},
            .meaning = "`longitude latitude`: x and y are degrees on a sphere. Velocities are lengths per time to the "
                       "east and to the north, densities are per area, blobs are round on the sphere. A domain of 360 "
                       "degrees is periodic in x. Without this key all coordinates are lengths"},
           {.name = "radius",
            .type = Type::number,
            .fallback = "6371000",
            .range = positive,
            .unit = "length",
            .meaning = "radius of the sphere that `coordinates` needs. The default is that of the Earth in metres"},
           {.name = "edges",
            .type = Type::ends,
            .fallback = "unbounded",
            .choices = {"unbounded", "periodic", "open", "closed"},
            .meaning =
                "what happens at the ends of each axis: a word for both ends, or a pair of words for the lower and the "
                "upper one, as in `[\"periodic\", [\"closed\", \"open\"]]`. `unbounded`: nothing, particles go on "
                "beyond it. `periodic`: what goes out comes in at the other end. `open`: particles that pass it leave "
                "the run and are counted. `closed`: nothing passes, particles are reflected and the density has no "
                "flux there"},
           {.name = "coast",
            .type = Type::choice,
            .choices = {"stop", "slide", "remove"},
            .meaning = "what happens to particles that reach land, where a velocity in a file has no values: `stop`, "
                       "they stay there; `slide`, they move along it; `remove`, they leave the run and are counted. "
                       "Without it a particle that reaches land ends the run with an error"}}};
}

namespace {

bool is_corner(Reader& in, const Value& value, const Key& key) {
  if (value.items.size() == 2 || value.items.size() == 3) return true;
  in.diagnostics.error(value.place, fmt::format("{} needs 2 numbers (2D) or 3 numbers (3D), found {}", in.label_of(key),
                                                value.items.size()));
  return false;
}

constexpr std::size_t ends_of_an_axis = 2;

/// A word for both ends of an axis, or one for each.
void read_ends(Reader& in, const Value& value, const Key& key, const std::string& axis, std::array<Edge, 2>& ends) {
  const auto read = [&](const Value& word, Edge& edge) {
    if (const auto index = in.choice_in(word, key, fmt::format("{} along {}", in.label_of(key), axis)))
      edge = static_cast<Edge>(*index);
  };
  if (value.kind != Value::Kind::list) {
    read(value, ends[0]);
    ends[1] = ends[0];
    return;
  }
  if (value.items.size() != ends_of_an_axis) {
    in.diagnostics.error(value.place,
                         fmt::format("the ends of {} need one word, or 2 words, found {}", axis, value.items.size()),
                         "[\"closed\", \"open\"]: the lower end is closed, the upper one open");
    return;
  }
  for (std::size_t end = 0; end < ends_of_an_axis; ++end) read(value.items[end], ends[end]);
  if ((ends[0] == Edge::periodic) != (ends[1] == Edge::periodic))
    in.diagnostics.error(value.place, fmt::format("one end of {} is periodic, the other is not", axis),
                         "an axis is periodic at both ends: write \"periodic\" for it");
}

void read_edges(Reader& in, Domain& domain) {
  const Key& key = find_key("domain", "edges");
  const Entry* entry = in.find("domain", "edges");
  if (!entry) return;
  if (entry->value.kind != Value::Kind::list) return in.wrong_type(entry->value, in.label_of(key), type_text(key));
  if (in.facts.dimension == 0 || !in.has_entries(entry->value, key, "word")) return;
  for (std::size_t k = 0; k < entry->value.items.size(); ++k)
    read_ends(in, entry->value.items[k], key, std::string(1, "xyz"[k]), domain.edges[k]);
}

/// A domain that goes all the way round is periodic there.
void go_round(Reader& in, Domain& domain, const Place& place) {
  constexpr double whole = 360, rounding = 1e-9;
  const double length = domain.max[0] - domain.min[0];
  const Entry* edges = in.find("domain", "edges");
  if (length > whole + rounding)
    in.diagnostics.error(place,
                         fmt::format("the domain reaches over {:g} degrees of longitude, and there are 360", length),
                         "max[0] - min[0] is at most 360");
  const bool round = std::abs(length - whole) <= rounding;
  if (!edges && round) domain.edges[0] = {Edge::periodic, Edge::periodic};
  if (!edges) return;
  const bool periodic = domain.edges[0][0] == Edge::periodic;
  if (round && !periodic)
    in.diagnostics.error(edges->value.place,
                         "the domain goes all the way round, and its edges along x are not periodic",
                         "\"periodic\" for x, or a domain of less than 360 degrees");
  if (!round && periodic)
    in.diagnostics.error(
        edges->value.place,
        fmt::format("the domain reaches over {:g} degrees of longitude and cannot be periodic", length),
        "let it reach over 360, as from -180 to 180, or use \"open\"");
  if (domain.edges[1][0] == Edge::periodic)
    in.diagnostics.error(edges->value.place, "latitudes are not periodic", "\"open\" or \"unbounded\" for y");
  if (domain.has(Edge::closed))
    in.diagnostics.error(edges->value.place,
                         "closed edges need blobs mirrored beyond them, which are not known on a sphere",
                         "\"open\" or \"unbounded\"");
}

void read_coordinates(Reader& in, Domain& domain, const Value& min, const Value& max) {
  const Entry* coordinates = in.find("domain", "coordinates");
  const Entry* radius = in.find("domain", "radius");
  if (!coordinates) {
    if (radius)
      in.diagnostics.error(radius->place, "domain.radius is that of a sphere, and there is none",
                           fmt::format("coordinates = \"{}\" in [domain]", longitude_latitude));
    return;
  }
  const Key& key = find_key("domain", "coordinates");
  if (!in.choice_in(coordinates->value, key, in.label_of(key))) return;
  if (domain.dimension != 2)
    in.diagnostics.error(coordinates->value.place, "longitudes and latitudes need a domain of 2 dimensions, this has 3",
                         "leave out the third numbers of min and max");
  if (const auto number = in.number("domain", "radius")) domain.sphere = number->number;
  if (domain.dimension != 2 || !domain.on_sphere()) return;
  constexpr double most = 89;
  for (const auto& [latitude, value] : {std::pair{domain.min[1], &min}, std::pair{domain.max[1], &max}})
    if (std::abs(latitude) > most)
      in.diagnostics.error(
          value->items[1].place,
          fmt::format("the domain reaches to the latitude {:g}, too near to a pole: there a degree of longitude has "
                      "hardly any length, and particles would run round faster than any step",
                      latitude),
          fmt::format("latitudes from -{0:g} to {0:g}", most));
  go_round(in, domain, max.items[0].place);
}

/// As short as it can be.
std::string written_edges(const Domain& domain) {
  const auto word = [](Edge edge) { return written_choice(find_key("domain", "edges"), edge); };
  std::vector<std::string> axes;
  for (std::size_t k = 0; k < static_cast<std::size_t>(domain.dimension); ++k) {
    const auto& [lower, upper] = domain.edges[k];
    axes.push_back(lower == upper ? word(lower) : fmt::format("[{}, {}]", word(lower), word(upper)));
  }
  return fmt::format("[{}]", fmt::join(axes, ", "));
}

}  // namespace

void read_domain(Reader& in, Domain& domain) {
  const Key &min_key = find_key("domain", "min"), &max_key = find_key("domain", "max");
  const Entry *min_entry = in.require(min_key), *max_entry = in.require(max_key);
  const auto min = min_entry ? in.numbers(*min_entry, min_key) : std::nullopt;
  const auto max = max_entry ? in.numbers(*max_entry, max_key) : std::nullopt;
  const bool min_fits = min && is_corner(in, min_entry->value, min_key),
             max_fits = max && is_corner(in, max_entry->value, max_key);
  if (min_fits && max_fits && min->size() != max->size()) {
    in.diagnostics.error(max_entry->value.place,
                         fmt::format("domain.min has {} numbers, domain.max has {}", min->size(), max->size()),
                         "2 numbers each in 2D, 3 in 3D");
    return;
  }
  if (min_fits || max_fits) in.facts.dimension = static_cast<int>(min_fits ? min->size() : max->size());
  if (!min_fits || !max_fits) return;
  domain.dimension = in.facts.dimension;
  bool valid = true;
  for (std::size_t k = 0; k < min->size(); ++k) {
    const double lower = (*min)[k], upper = (*max)[k];
    domain.min[k] = lower, domain.max[k] = upper;
    if (lower < upper && std::isfinite(upper - lower)) continue;
    valid = false;
    in.diagnostics.error(max_entry->value.items[k].place,
                         lower < upper
                             ? fmt::format("the domain is too wide along {} for double precision", "xyz"[k])
                             : fmt::format("the domain is empty along {}: min = {}, max = {}", "xyz"[k], lower, upper),
                         "min must be less than max on every axis");
  }
  read_edges(in, domain);
  if (const Entry* coast = in.find("domain", "coast")) {
    const Key& key = find_key("domain", "coast");
    if (const auto rule = in.choice_in(coast->value, key, in.label_of(key)))
      domain.coast = static_cast<AtCoast>(*rule + 1);  // without the key: refuse, the first one
  }
  read_coordinates(in, domain, min_entry->value, max_entry->value);
  in.facts.on_sphere = domain.on_sphere();
  in.facts.domain_valid = valid;
  in.facts.box = {domain.dimension, domain.min, domain.max};
}

void write_domain(Writer& out, const Domain& domain) {
  const auto corner = [&](const std::array<double, 3>& point) {
    return written(std::vector<double>(point.begin(), point.begin() + domain.dimension));
  };
  out.table("domain");
  out.entry("min", corner(domain.min));
  out.entry("max", corner(domain.max));
  if (domain.on_sphere()) {
    out.entry("coordinates", written(std::string(longitude_latitude)));
    out.entry("radius", written(domain.sphere));
  }
  if (domain.has_edges()) out.entry("edges", written_edges(domain));
  if (domain.coast != AtCoast::refuse)
    out.entry("coast",
              written(std::string(find_key("domain", "coast").choices[static_cast<std::size_t>(domain.coast) - 1])));
}

}  // namespace gaussdrift::input
