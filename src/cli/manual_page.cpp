#include "cli/manual_page.hpp"

#include <fmt/format.h>

#include <cctype>

namespace gaussdrift::cli {
namespace {

/// Text as roff takes it: with the minus sign that can be copied into a shell, and no line that looks like a request.
std::string roff(std::string_view text) {
  std::string safe;
  for (const char c : text) {
    if (c == '\\')
      safe += "\\e";
    else if (c == '-')
      safe += "\\-";
    else
      safe += c;
  }
  return safe.find_first_of(".'") == 0 ? "\\&" + safe : safe;
}

std::string capitalised(std::string text) {
  if (!text.empty()) text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text;
}

std::string with_full_stop(const std::string& text) { return text + (text.empty() || text.back() == '.' ? "" : "."); }

std::string value(const OptionWords& option, bool may_be_left_out) {
  const std::string slanted = fmt::format("\\fI{}\\fR", roff(option.type));
  return may_be_left_out ? "[" + slanted + "]" : slanted;
}

std::string synopsis(const VerbWords& verb) {
  std::string line = fmt::format("gaussdrift {} \\fR[\\fIoptions\\fR]", verb.name);
  for (const OptionWords& option : verb.options)
    if (option.is_word()) line += " " + value(option, !option.required);
  return line;
}

std::string option_paragraph(const OptionWords& option) {
  std::string head = option.is_word() ? value(option, false) : fmt::format("\\fB{}\\fR", roff(option.name));
  if (option.is_word() && !option.dashed().empty()) head += fmt::format(", \\fB{}\\fR", roff(option.dashed()));
  if (!option.type.empty() && !option.dashed().empty()) head += " " + value(option, option.value_optional);
  std::string meaning = with_full_stop(roff(capitalised(option.meaning)));
  if (!option.range.empty()) meaning += fmt::format(" Range: {}.", roff(option.range));
  if (option.required && !option.is_word()) meaning += " Required.";
  if (option.repeatable && meaning.find("Repeatable") == std::string::npos) meaning += " Repeatable.";
  return fmt::format(".TP\n{}\n{}\n", head, meaning);
}

std::string section(const VerbWords& verb) {
  std::string text = fmt::format(".SS \"{}\"\n{}\n", synopsis(verb), with_full_stop(roff(capitalised(verb.meaning))));
  for (const OptionWords& option : verb.options) text += option_paragraph(option);
  return text;
}

}  // namespace

std::string manual_page(const ProgramWords& program) {
  std::string page = fmt::format(
      ".TH GAUSSDRIFT 1 \"\" \"gaussdrift {}\" \"User Commands\"\n"
      ".SH NAME\ngaussdrift \\- smoothed\\-particle advection of a density in a prescribed flow\n"
      ".SH SYNOPSIS\n.B gaussdrift\n.I command\n[\\fIoptions\\fR]\n.br\n.B gaussdrift\n.RB [ \\-\\-help | "
      "\\-\\-version ]\n"
      ".SH DESCRIPTION\n{}\n.PP\n"
      "A scene is a text file in TOML, a \\fIcase\\fR. \\fBgaussdrift explain\\fR lists its keys.\n"
      "Called without arguments, the program tells what to do first.\n.SH COMMANDS\n",
      program.version, roff(program.purpose));
  for (const VerbWords& verb : program.verbs) page += section(verb);
  page += ".SH EXIT STATUS\n";
  for (const ExitMeaning& exit : program.exits)
    page += fmt::format(".TP\n.B {}\n{}\n", exit.code, with_full_stop(roff(capitalised(std::string(exit.meaning)))));
  page +=
      ".SH FILES\n.TP\n.I output/<name>/\nResults of a run of the case \\fI<name>.toml\\fR, in the folder that the "
      "program was "
      "called in.\n"
      ".SH EXAMPLES\n.nf\ngaussdrift new rotating_cone\ngaussdrift run rotating_cone.toml\n"
      "gaussdrift new \\-\\-blank 2d\ngaussdrift check scene.toml\n.fi\n"
      ".SH AUTHORS\nThe gaussdrift developers.\n";
  return page;
}

}  // namespace gaussdrift::cli
