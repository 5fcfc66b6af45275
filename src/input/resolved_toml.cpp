// A Case as a case file again, every default spelt out. Numbers have as many digits as it takes to read the same bits.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <set>

#include "effect/catalogue.hpp"
#include "expression/expression.hpp"
#include "field/gaussians/gaussian_velocity.hpp"
#include "gaussdrift/read_case.hpp"
#include "input/data_files.hpp"
#include "input/registry.hpp"
#include "particle/cutoff.hpp"
#include "time/tableau.hpp"

namespace gaussdrift {

using namespace input;  // this is the public face of that module

namespace {

std::string written(double value) {
  if (value == 0 && std::signbit(value)) return "-0.0";  // -0 would be a whole number and lose its sign
  return fmt::format("{}", value);
}

std::string written(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\')
      out += fmt::format("\\{}", c);
    else if (code < 0x20 || code == 0x7F)
      out += fmt::format("\\u{:04X}", code);
    else
      out += c;
  }
  return out + "\"";
}

template <class Item>
std::string written(const std::vector<Item>& list) {
  std::vector<std::string> items;
  items.reserve(list.size());
  for (const auto& item : list) items.push_back(written(item));
  return fmt::format("[{}]", fmt::join(items, ", "));
}

std::string written_point(const std::array<double, 3>& point, int dimension) {
  return written(std::vector<double>(point.begin(), point.begin() + dimension));
}

bool is_expression(const NamedParameter& parameter) {
  return parameter.kind == NamedParameter::Kind::expression ||
         parameter.kind == NamedParameter::Kind::expression_in_time;
}

/// The value of an effect's key.
std::string written_value(const NamedParameter& parameter, const EffectSpec& effect) {
  switch (parameter.kind) {
    case NamedParameter::Kind::number:
      return written(effect.number(parameter.name));
    case NamedParameter::Kind::whole:
      return fmt::format("{:.0f}", effect.number(parameter.name));
    case NamedParameter::Kind::point:
      return written(effect.point(parameter.name));
    case NamedParameter::Kind::choice:
    case NamedParameter::Kind::expression:
    case NamedParameter::Kind::expression_in_time:
      return written(effect.text(parameter.name));
  }
  return "";
}

/// The names of enumerators are the choices of the key, in the same order.
template <class Enum>
std::string choice(std::string_view table, std::string_view name, Enum value) {
  return std::string(find_key(table, name).choices.at(static_cast<std::size_t>(value)));
}

template <class Thing>
std::string written_names(const std::vector<Thing>& things) {
  std::vector<std::string> names;
  for (const Thing& thing : things) names.emplace_back(thing.name);
  return written(names);
}

class Writer {
 public:
  explicit Writer(std::filesystem::path folder) : folder_(std::move(folder)) {}
  void table(std::string_view name) { text_ += fmt::format("\n[{}]\n", name); }
  /// One of `count` parts of a table that may be repeated.
  void part(std::string_view name, std::size_t count) {
    text_ += count == 1 ? fmt::format("\n[{}]\n", name) : fmt::format("\n[[{}]]\n", name);
  }
  /// Parameters of a named formula; an infinite one is the default "none".
  void arguments(std::string_view table, const std::string& named, const Arguments& list) {
    for (const auto& [name, values] : list) {
      const bool single = find_key(table, name, named).type == Type::number;
      if (!single || std::isfinite(values[0])) entry(name, single ? written(values[0]) : written(values));
    }
  }
  void entry(std::string_view name, const std::string& value) { text_ += fmt::format("{} = {}\n", name, value); }
  template <class FileSpec>
  void file(const FileSpec& spec) {
    entry("file", data_file(spec.file));
    if (spec.arrays.size() == 1) entry("array", written(spec.arrays[0]));
    if (spec.arrays.size() > 1) entry("arrays", written(spec.arrays));
    entry("interpolation", written(spec.interpolation));
    entry("outside", written(spec.outside));
    entry("missing", written(spec.missing));
    if (spec.missing_value) entry("missing_value", written(*spec.missing_value));
  }
  void gaussians(const GaussianVelocitySpec& spec) {
    entry("gaussians", data_file(spec.file));
    entry("kind", written(spec.kind));
    entry("width", written(spec.model->width));
    if (spec.residual > 0) entry("residual", written(spec.residual));
    if (spec.residual > 0) entry("regularisation", written(spec.regularisation));
    entry("tolerance", written(spec.tolerance));
  }
  const std::string& text() const { return text_; }

 private:
  std::string data_file(const std::filesystem::path& file) const {
    return written((folder_.empty() ? file : seen_from(folder_, file)).generic_string());
  }

  std::filesystem::path folder_;
  std::string text_;
};

// Numbers are written as values, so only the parameters that expressions of fields mention are still needed.
Params params_in_use(const Case& scene) {
  std::vector<std::string> texts;
  for (const auto& part : scene.velocity)
    if (const auto* velocity = std::get_if<ExpressionVelocity>(&part))
      texts.insert(texts.end(), velocity->components.begin(), velocity->components.end());
    else if (const auto* stream = std::get_if<StreamfunctionVelocity>(&part))
      texts.push_back(stream->psi);
  for (const auto& part : scene.density)
    if (const auto* density = std::get_if<ExpressionDensity>(&part)) texts.push_back(density->text);
  if (scene.reference.kind == ReferenceSpec::Kind::exact) texts.push_back(scene.reference.rho);
  for (const auto& [effect, spec] : effects_of(scene.effects))
    for (const NamedParameter& parameter : effect->about.parameters)
      if (is_expression(parameter) && spec.has(parameter.name)) texts.push_back(spec.text(parameter.name));
  std::set<std::string> mentioned;
  for (const std::string& text : texts) {
    const Expression expression(text, {"x", "y", "z", "t"}, scene.params);
    mentioned.insert(expression.used_names().begin(), expression.used_names().end());
  }
  Params params;
  for (const auto& param : scene.params)
    if (mentioned.count(param.first) > 0) params.push_back(param);
  return params;
}

}  // namespace

std::string case_text(const Case& scene, const std::filesystem::path& folder) {
  const int dimension = scene.domain.dimension;
  Writer out(folder);
  out.entry("gaussdrift", "1");
  out.table("case");
  out.entry("title", written(scene.title));
  out.entry("cite", written(scene.cite));
  const Params params = params_in_use(scene);
  if (!params.empty()) out.table("params");
  for (const auto& [name, value] : params) out.entry(name, written(value));
  out.table("domain");
  out.entry("min", written_point(scene.domain.min, dimension));
  out.entry("max", written_point(scene.domain.max, dimension));
  for (const auto& part : scene.velocity) {
    out.part("velocity", scene.velocity.size());
    if (const auto* field = std::get_if<ExpressionVelocity>(&part)) {
      out.entry("u", written(field->components));
    } else if (const auto* stream = std::get_if<StreamfunctionVelocity>(&part)) {
      out.entry("streamfunction", written(stream->psi));
    } else if (const auto* grid = std::get_if<FileVelocity>(&part)) {
      out.file(*grid);
    } else if (const auto* gaussians = std::get_if<GaussianVelocitySpec>(&part)) {
      out.gaussians(*gaussians);
    } else if (const auto* named = std::get_if<NamedVelocity>(&part)) {
      out.entry("field", written(named->field));
      out.arguments("velocity", named->field, named->arguments);
    }
  }
  for (const auto& part : scene.density) {
    out.part("density", scene.density.size());
    if (const auto* field = std::get_if<ExpressionDensity>(&part)) {
      out.entry("expression", written(field->text));
    } else if (const auto* grid = std::get_if<FileDensity>(&part)) {
      out.file(*grid);
    } else if (const auto* shape = std::get_if<ShapeDensity>(&part)) {
      out.entry("shape", written(shape->shape));
      out.arguments("density", shape->shape, shape->arguments);
    }
  }
  out.table("particles");
  out.entry("per_axis", fmt::format("{}", scene.particles.per_axis));
  out.entry("overlap", written(scene.particles.overlap));
  out.entry("cutoff", written(scene.particles.cutoff));
  const Arguments cutoff_arguments = complete(scene.particles.cutoff, find_cutoff(scene.particles.cutoff).parameters,
                                              scene.particles.cutoff_arguments, {});
  for (const auto& [name, values] : cutoff_arguments) out.entry(name, written(values.at(0)));
  out.entry("threshold", written(scene.particles.threshold));
  out.table("time");
  out.entry("end", written(scene.time.end));
  if (scene.time.step > 0) out.entry("step", written(scene.time.step));
  out.entry("method", written(scene.time.method));
  if (time::is_adaptive(time::find_tableau(scene.time.method))) out.entry("tolerance", written(scene.time.tolerance));
  out.table("evaluate");
  if (scene.evaluate.spacing > 0)
    out.entry("spacing", written(scene.evaluate.spacing));
  else
    out.entry("per_axis", fmt::format("{}", scene.evaluate.per_axis));
  out.entry("tolerance", written(scene.evaluate.tolerance));
  out.entry("method", written(scene.evaluate.method));
  if (scene.evaluate.most_seconds > 0) out.entry("most_seconds", written(scene.evaluate.most_seconds));
  out.table("output");
  out.entry("times", written(scene.output.times));
  out.entry("vtk", written_names(scene.output.files));
  out.entry("images", written_names(scene.output.images));
  out.entry("report", written(std::string(scene.output.report ? "html" : "none")));
  for (const auto& [effect, written_effect] : effects_of(scene.effects)) {
    out.table(fmt::format("effects.{}", written_effect.name));
    for (const NamedParameter& parameter : effect->about.parameters)
      if (written_effect.has(parameter.name)) out.entry(parameter.name, written_value(parameter, written_effect));
  }
  out.table("reference");
  out.entry("kind", written(choice("reference", "kind", scene.reference.kind)));
  if (scene.reference.kind == ReferenceSpec::Kind::exact) out.entry("rho", written(scene.reference.rho));
  if (scene.reference.points) out.entry("points", fmt::format("{}", *scene.reference.points));
  out.table("accuracy");
  if (scene.accuracy.target) out.entry("target", written(*scene.accuracy.target));
  out.entry("budget", written(choice("accuracy", "budget", scene.accuracy.budget)));
  for (const CheckSpec& check : scene.checks) {
    out.part("check", scene.checks.size());
    out.entry("what", written(choice("check", "what", check.what)));
    if (check.max) out.entry("max", written(*check.max));
    if (check.min) out.entry("min", written(*check.min));
    if (check.at) out.entry("at", written(*check.at));
  }
  return out.text();
}

}  // namespace gaussdrift
