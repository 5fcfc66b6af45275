// [[source]]: what enters during the run.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "field/density/shapes.hpp"
#include "gaussdrift/error.hpp"
#include "input/data_files.hpp"
#include "input/points_table.hpp"
#include "input/tables/tables.hpp"
#include "sim/borders/edges.hpp"

namespace gaussdrift::input {

Section sources_section() {
  std::vector<Key> keys{
      {.name = "shape",
       .type = Type::choice,
       .choices = base::names_of(named_shapes()),
       .meaning = "name of a shape that is released, as in `[density]`. Its parameters stand beside it"}};
  add_parameters(keys, "shape", named_shapes());
  const std::vector<Key> more{
      {.name = "point", .type = Type::point, .unit = "length", .meaning = "the place of a blob that is released"},
      {.name = "amount",
       .type = Type::number,
       .unit = "density length^d",
       .meaning = "the mass that a point releases at one time",
       .with = "point"},
      {.name = "points",
       .meaning = "a table of blobs that are released, with the columns x, y, z in space, t and amount: text, .npy or "
                  ".vtp. The path is relative to the case file"},
      {.name = "face",
       .type = Type::choice,
       .choices = {"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"},
       .meaning =
           "a face of the domain, open or unbounded, through which the velocity carries something in. One particle "
           "a spacing and puff brings what comes in"},
      {.name = "concentration",
       .type = Type::expression,
       .meaning = "of what comes in through the face: a density, an expression in x, y, z, t and params",
       .with = "face"},
      {.name = "tracer", .meaning = "which of the named densities is released, where `[[density]]` has names"},
      {.name = "at", .type = Type::number, .unit = "time", .meaning = "the time at which all of it is released"},
      {.name = "from",
       .type = Type::number,
       .unit = "time",
       .meaning = "in place of `at`: the begin of an interval during which it is released. A face lets in from "
                  "`time.start` on where this is left out"},
      {.name = "to",
       .type = Type::number,
       .unit = "time",
       .meaning = "the end of that interval. A face lets in until `time.end` where this is left out"},
      {.name = "rate",
       .type = Type::expression,
       .meaning =
           "with `from` and `to`: what is released in a unit of time, an expression in t and params. For a point "
           "it is a mass. For a shape it is a factor of its density"},
      {.name = "puffs",
       .type = Type::whole,
       .fallback = "100",
       .range = {1, 1e6},
       .meaning = "with `from` and `to`: the number of equal parts of the interval. What is released during a part is "
                  "released at once in its middle. Steps land there, so that no step is longer than a part"}};
  keys.insert(keys.end(), more.begin(), more.end());
  return {
      Table{.name = "source",
            .required = false,
            .meaning = "what is released during the run, at one time or over an interval at a rate. It is carried on "
                       "as the density at the start is. Several `[[source]]` are possible. It does not go with "
                       "most effects, nor with an exact density by characteristics",
            .kinds = {"shape", "point", "points", "face"}},
      keys};
}

namespace {

using Kind = Value::Kind;

constexpr const char* where_sources_are =
    "sources lie in the domain, as the density at the start does; enlarge the domain";

/// The rows of a table, read at once so that everything wrong with them has its place in the case file.
PointsSourceSpec table_of_points(Reader& in, const Value& value, const TimeSpec& clock) {
  constexpr std::size_t memory_limit = std::size_t{2} << 30;
  PointsSourceSpec spec;
  if (value.kind != Kind::text) {
    in.wrong_type(value, in.label_of(find_key("source", "points")), "the name of a file in a string");
    return spec;
  }
  if (!in.facts.dimension || !in.facts.domain_valid) return spec;
  spec.file = find_data_file(in.folder, value.text);
  std::vector<std::string> columns{"x", "y", "t", "amount"};
  if (in.facts.dimension == 3) columns.insert(columns.begin() + 2, "z");
  try {
    NamedColumns read = read_named_columns(spec.file, columns, memory_limit);
    const std::size_t width = columns.size();
    std::size_t late = 0;
    for (std::size_t row = 0; row < read.rows.size() / width; ++row) {
      double* const numbers = read.rows.data() + row * width;
      const auto refuse = [&](const std::string& what) {
        throw InputError(fmt::format("{}:{}:1: {}", spec.file.string(), read.lines.line_of(row), what));
      };
      if (!is_in_domain(in, numbers)) refuse(fmt::format("the point lies outside the domain; {}", where_sources_are));
      double& time = numbers[width - 2];
      const double written = time;
      time = clock.elapsed(written);
      if (time < 0)
        refuse(
            fmt::format("t = {:g} lies before the run, which begins at {}; leave out the row", written, clock.start));
      if (in.facts.end && time > *in.facts.end) ++late;
    }
    if (late > 0)
      in.diagnostics.warning(value.place,
                             fmt::format("{} of the {} rows of {} are beyond time.end, so that nothing of them is "
                                         "released",
                                         late, read.rows.size() / width, value.text),
                             "lengthen time.end, or leave them out");
    spec.rows = std::make_shared<const std::vector<double>>(std::move(read.rows));
  } catch (const Error& error) {
    in.diagnostics.error(value.place, error.what(), where_data_file_was(in.folder, value.text));
  }
  return spec;
}

void warn_if_late(Reader& in, const Entry& entry, double elapsed, const TimeSpec& clock) {
  if (in.facts.end && elapsed > *in.facts.end)
    in.diagnostics.warning(
        entry.value.place,
        fmt::format("{} = {:g} is {} than time.end = {:g}, so that nothing is released",
                    in.label_of(find_key("source", entry.name)), clock.at(elapsed),
                    clock.backwards ? "earlier" : "later", clock.at(clock.end)),
        clock.backwards ? "let the run go back farther, or release later" : "lengthen time.end, or release earlier");
}

/// A time of the run, elapsed; nothing after a complaint.
std::optional<double> time_of(Reader& in, std::string_view name, const TimeSpec& clock) {
  const auto time = in.number("source", name);
  if (!time) return std::nullopt;
  if (const double elapsed = clock.elapsed(time->number); elapsed >= 0) return elapsed;
  in.diagnostics.error(time->written->place,
                       fmt::format("{} = {} lies before the run, which begins at {}{}",
                                   in.label_of(find_key("source", name)), found_number(time->number, *time->written),
                                   clock.start, clock.backwards ? " and goes backwards" : ""));
  return std::nullopt;
}

/// At one time.
void read_moment(Reader& in, SourceSpec& source, const TimeSpec& clock) {
  source.at = time_of(in, "at", clock).value_or(0);
  warn_if_late(in, *in.find("source", "at"), *source.at, clock);
  for (const char* name : {"to", "rate", "puffs"})
    if (const Entry* entry = in.find("source", name))
      in.diagnostics.error(entry->place, fmt::format("\"{}\" goes with \"from\", not with \"at\"", name),
                           "at = 2 releases all of it at once; from, to and rate release it over an interval");
  auto* const point = std::get_if<PointSourceSpec>(&source.what);
  if (!point) return;
  if (const auto amount = in.number("source", "amount"))
    point->amount = amount->number;
  else if (!in.find("source", "amount"))
    in.diagnostics.error(in.find("source", "at")->place, "a point that releases at one time needs an \"amount\"",
                         meaning_note(find_key("source", "amount")));
}

void read_interval(Reader& in, SourceSpec& source, const TimeSpec& clock) {
  for (const char* name : {"to", "rate"})
    if (!in.find("source", name) && !in.is_meant(fmt::format("{}.{}", in.label_of("source"), name)))
      in.diagnostics.error(in.find("source", "from")->place,
                           fmt::format("a release over an interval needs \"{}\"", name),
                           meaning_note(find_key("source", name)));
  if (const Entry* amount = in.find("source", "amount"))
    in.diagnostics.error(amount->place, "\"amount\" goes with \"at\", not with \"from\"",
                         "the rate says how much: rate = \"3\" over an interval of length 2 releases 6");
  const auto from = time_of(in, "from", clock), to = time_of(in, "to", clock);
  source.from = from.value_or(0), source.to = to.value_or(0);
  const Entry *begin = in.find("source", "from"), *end = in.find("source", "to");
  if (from && to && !(*to > *from))
    in.diagnostics.error(end->value.place,
                         fmt::format("{} = {:g} must be {} than from = {:g}{}", in.label_of(find_key("source", "to")),
                                     clock.at(*to), clock.backwards ? "earlier" : "later", clock.at(*from),
                                     clock.backwards ? ", because the run goes backwards" : ""));
  if (from) warn_if_late(in, *begin, *from, clock);
  if (const Entry* rate = in.find("source", "rate"))
    source.rate = in.time_expression(rate->value, in.label_of(find_key("source", "rate")));
  if (const auto puffs = in.number("source", "puffs")) source.puffs = to_int(*puffs);
}

/// Which of the named densities it is.
void read_tracer(Reader& in, SourceSpec& source, const std::vector<TracerSpec>& tracers) {
  const Entry* tracer = in.find("source", "tracer");
  if (tracers.empty() && tracer)
    in.diagnostics.error(tracer->place, "no density of this case has a name", "[[density]] name = \"A\" names one");
  if (tracers.empty()) return;
  std::vector<std::string_view> names;
  for (const TracerSpec& one : tracers) names.push_back(one.name);
  const std::string wanted = in.text("source", "tracer");
  const auto found = std::find(names.begin(), names.end(), wanted);
  if (found == names.end())
    in.diagnostics.error(tracer ? tracer->value.place : in.table("source")->place,
                         tracer ? fmt::format("no density is called \"{}\"", wanted)
                                : std::string("a source does not say which of the named densities it releases"),
                         fmt::format("tracer = one of {}", quoted_list(names)));
  else
    source.tracer = static_cast<std::size_t>(found - names.begin());
}

/// Through a face, during the whole run if nothing else is said.
void read_inflow(Reader& in, SourceSpec& source, const TimeSpec& clock) {
  for (const char* name : {"at", "rate"})
    if (const Entry* entry = in.find("source", name))
      in.diagnostics.error(entry->place, fmt::format("\"{}\" does not go with \"face\"", name),
                           "the velocity and the concentration say how much comes in, from \"from\" to \"to\"");
  source.from = 0, source.to = clock.end;
  const Entry *begin = in.find("source", "from"), *end = in.find("source", "to");
  if (begin) source.from = time_of(in, "from", clock).value_or(0);
  if (end) source.to = time_of(in, "to", clock).value_or(clock.end);
  if (begin) warn_if_late(in, *begin, source.from, clock);
  if ((begin || end) && !(source.to > source.from) && clock.end > 0)
    in.diagnostics.error((end ? end : begin)->value.place, "nothing comes in between \"from\" and \"to\"",
                         "the run has to meet \"to\" after \"from\"");
  if (const auto puffs = in.number("source", "puffs")) source.puffs = to_int(*puffs);
  if (!in.find("source", "concentration") && !in.is_meant(fmt::format("{}.concentration", in.label_of("source"))))
    in.diagnostics.error(in.find("source", "face")->place, "a face needs a \"concentration\"",
                         meaning_note(find_key("source", "concentration")));
}

/// A face of the domain through which something may come.
FaceSourceSpec face_of(Reader& in, const Value& value, const Domain& domain) {
  FaceSourceSpec face{.axis = value.text[0] - 'x', .upper = value.text.ends_with("max"), .concentration = {}};
  if (in.facts.dimension && face.axis >= in.facts.dimension) {
    in.diagnostics.error(
        value.place, fmt::format("the domain has no face {}: it has {} dimensions", value.text, in.facts.dimension));
    return face;
  }
  const Edge edge = domain.edges[static_cast<std::size_t>(face.axis)][face.upper];
  if (edge == Edge::closed || edge == Edge::periodic)
    in.diagnostics.error(
        value.place,
        edge == Edge::closed
            ? fmt::format("nothing can come in through {}, which is closed", value.text)
            : fmt::format("through {}, which is periodic, comes what goes out at the other end", value.text),
        "edges that are \"open\" or \"unbounded\" let something in");
  if (const Entry* concentration = in.find("source", "concentration"))
    face.concentration =
        in.field_expression(concentration->value, in.label_of(find_key("source", "concentration")), true);
  return face;
}

void read_when(Reader& in, SourceSpec& source, const TimeSpec& clock) {
  if (std::holds_alternative<PointsSourceSpec>(source.what)) {
    for (const char* name : {"at", "from", "to", "rate", "puffs"})
      if (const Entry* entry = in.find("source", name))
        in.diagnostics.error(entry->place, fmt::format("\"{}\" does not go with \"points\"", name),
                             "the table says when and how much: its columns t and amount");
    return;
  }
  if (std::holds_alternative<FaceSourceSpec>(source.what)) return read_inflow(in, source, clock);
  const auto kind = in.exactly_one("source", {"at", "from"});
  if (!kind) return;
  *kind == "at" ? read_moment(in, source, clock) : read_interval(in, source, clock);
}

}  // namespace

void read_sources(Reader& in, Case& spec) {
  in.each_part("source", [&](std::string_view kind, const Value& value) {
    SourceSpec source;
    const Key& key = find_key("source", kind);
    if (kind == "shape")
      source.what = ShapeDensitySpec{value.text, in.arguments(key, find_named_shape(value.text).about, value)};
    if (kind == "face") source.what = face_of(in, value, spec.domain);
    if (kind == "points") source.what = table_of_points(in, value, spec.time);
    if (kind == "point") {
      const auto place = in.point_of(key, *in.find("source", "point"));
      if (place && in.facts.domain_valid && !is_in_domain(in, place->data()))
        in.diagnostics.error(value.place, fmt::format("{} lies outside the domain", in.label_of(key)),
                             where_sources_are);
      source.what = PointSourceSpec{place.value_or(std::vector<double>{})};
    }
    read_tracer(in, source, spec.tracers);
    read_when(in, source, spec.time);
    spec.sources.push_back(std::move(source));
  });
}

void write_sources(Writer& out, const Case& spec) {
  for (const SourceSpec& source : spec.sources) {
    out.part("source", spec.sources.size());
    if (!spec.tracers.empty()) out.entry("tracer", written(spec.tracers[source.tracer].name));
    if (const auto* shape = std::get_if<ShapeDensitySpec>(&source.what)) {
      out.entry("shape", written(shape->shape));
      out.arguments("source", shape->shape, shape->arguments);
    }
    if (const auto* table = std::get_if<PointsSourceSpec>(&source.what)) {
      out.entry("points", out.data_file(table->file));
      continue;
    }
    const auto* point = std::get_if<PointSourceSpec>(&source.what);
    if (point) out.entry("point", written(point->place));
    if (const auto* face = std::get_if<FaceSourceSpec>(&source.what)) {
      out.entry("face", written(Face{face->axis, face->upper}.name()));
      out.entry("concentration", written(face->concentration));
    }
    if (source.at) {
      if (point) out.entry("amount", written(point->amount));
      out.entry("at", written(spec.time.at(*source.at)));
      continue;
    }
    out.entry("from", written(spec.time.at(source.from)));
    out.entry("to", written(spec.time.at(source.to)));
    if (!source.rate.empty()) out.entry("rate", written(source.rate));
    out.entry("puffs", fmt::format("{}", source.puffs));
  }
}

}  // namespace gaussdrift::input
