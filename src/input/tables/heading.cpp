// The version of the format, and [case]: the title of the case and where it comes from.
#include <algorithm>

#include "base/printable.hpp"
#include "input/tables/tables.hpp"

namespace gaussdrift::input {

Key version_key() {
  return {.name = "gaussdrift",
          .type = Type::whole,
          .required = true,
          .range = {1, 1},
          .meaning = "version of the case format. This program reads version 1"};
}

Section case_section() {
  return {Table{.name = "case", .required = false, .meaning = "the title of the case and where it comes from"},
          {{.name = "title", .meaning = "one line of text for pictures and reports"},
           {.name = "cite", .meaning = "where the case comes from, for example a paper"},
           {.name = "label",
            .fallback = "density",
            .meaning = "what pictures and pages call the density, such as \"vorticity\""}}};
}

namespace {

/// Titles go to terminals, pages and pictures.
std::string one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == '\n' || c == '\r' || c == '\t'; }, ' ');
  return base::printable(text);
}

}  // namespace

void read_heading(Reader& in, Case& spec) {
  spec.title = one_line(in.text("case", "title"));
  spec.cite = one_line(in.text("case", "cite"));
  if (const std::string label = one_line(in.text("case", "label")); !label.empty()) spec.label = label;
}

void write_heading(Writer& out, const Case& spec) {
  out.entry("gaussdrift", "1");
  out.table("case");
  out.entry("title", written(spec.title));
  out.entry("cite", written(spec.cite));
  if (spec.label != Case{}.label) out.entry("label", written(spec.label));
}

}  // namespace gaussdrift::input
