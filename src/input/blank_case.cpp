#include "input/blank_case.hpp"

#include <fmt/format.h>

#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "effect/catalogue.hpp"
#include "input/registry.hpp"

namespace gaussdrift::input {
namespace {

/// A key of the form, with its value in the plane and in space.
struct Field {
  std::string_view name, plane, space = {};  // space: empty where it is that of the plane
  bool on = false;                           // else it is switched off
  std::string_view named = {};               // the shape that has the key
};

struct Form {
  std::string_view table;
  bool on = true;        // else all of it is switched off
  bool several = false;  // with double brackets
  std::vector<Field> fields;
  std::string_view note = {};  // a line of its own below
};

/// The table of the effect by which a density spreads.
std::string table_of_spreading() {
  for (const NamedEffect& effect : effects())
    if (effect.traits.diffuses) return table_of(effect);
  throw std::logic_error("no effect lets a density spread");
}

const std::vector<Form>& forms() {
  static const std::string spreading = table_of_spreading();
  static const std::vector<Form> all = {
      {"case", true, false, {{"title", "\"A blank scene\"", {}, true}, {"cite", "\"\""}}},
      {"params", false, false, {}, "R = 0.25"},
      {"domain",
       true,
       false,
       {{"min", "[-1, -1]", "[-1, -1, -1]", true},
        {"max", "[1, 1]", "[1, 1, 1]", true},
        {"edges", "[\"open\", \"periodic\"]", "[\"open\", \"open\", \"periodic\"]"}}},
      {"velocity",
       true,
       true,
       {{"u", "[\"-y\", \"x\"]", "[\"-y\", \"x\", \"0.1*cos(t)\"]", true}},
       "Velocities add up. Named ones, and data:  gaussdrift explain velocity"},
      {"density",
       true,
       true,
       {{"shape", "\"gaussian\"", {}, true},
        {"center", "[0.3, 0]", "[0.3, 0, 0]", true, "gaussian"},
        {"radius", "0.2", {}, true, "gaussian"}},
       "Densities add up. Formulas, pictures, data:  gaussdrift explain density"},
      {"particles", true, false, {{"per_axis", "100", "40", true}, {"overlap", "2"}, {"cutoff", "\"gauss4\""}}},
      {"time",
       true,
       false,
       {{"end", "\"pi/2\"", {}, true}, {"step", "0.05", {}, true}, {"start", "0"}, {"method", "\"rk4\""}}},
      {"evaluate", true, false, {{"per_axis", "100", "40", true}, {"tolerance", "1e-6"}}},
      {"output",
       true,
       false,
       {{"times", "[0, \"pi/4\", \"pi/2\"]", {}, true},
        {"vtk", "[\"density\", \"particles\"]", {}, true},
        {"images", "[\"heatmap\", \"surface\"]", "[\"projection\", \"slices\"]", true},
        {"fields", "[\"gradient\", \"velocity\"]"}}},
      {spreading, false, false, {{"D", "0.001"}}, "All effects:  gaussdrift explain effects"},
      {"accuracy", false, false, {{"target", "0.01"}}},
      {"check", false, true, {{"what", "\"Linf\""}, {"max", "0.1"}, {"at", "\"pi/2\""}}},
  };
  return all;
}

constexpr std::size_t column_of_comments = 42;

/// What fits beside a value: a sentence, or what stands before its colon.
std::string_view short_meaning(std::string_view meaning) {
  const std::string_view sentence = first_sentence(meaning);
  return sentence.size() <= 80 ? sentence : sentence.substr(0, sentence.find_first_of(":;"));
}

std::string line(bool on, const std::string& text, std::string_view comment) {
  const std::string left = (on ? "" : "# ") + text;
  return comment.empty() ? left + "\n" : fmt::format("{:<{}} # {}\n", left, column_of_comments, short_meaning(comment));
}

std::string part(const Form& form, int dimensions) {
  const std::string brackets = form.several ? "[[{}]]" : "[{}]";
  std::string text = line(form.on, fmt::format(fmt::runtime(brackets), form.table), find_table(form.table).meaning);
  for (const Field& field : form.fields) {
    const std::string_view value = dimensions == 3 && !field.space.empty() ? field.space : field.plane;
    text += line(form.on && field.on, fmt::format("{} = {}", field.name, value),
                 find_key(form.table, field.name, field.named).meaning);
  }
  if (!form.note.empty()) text += line(false, std::string(form.note), {});
  return text;
}

}  // namespace

std::string blank_case(int dimensions) {
  std::string text =
      "# A scene to fill in, which runs as it is. What is switched off by # shows what else there is.\n"
      "# All keys:  gaussdrift explain       One of them:  gaussdrift explain overlap\n"
      "gaussdrift = 1\n";
  for (const Form& form : forms()) text += "\n" + part(form, dimensions);
  return text;
}

}  // namespace gaussdrift::input
