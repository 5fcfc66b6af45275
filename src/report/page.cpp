#include "report/page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "base/json_file.hpp"
#include "base/shell_word.hpp"
#include "gaussdrift/error.hpp"
#include "render/chart_page.hpp"
#include "report/html.hpp"
#include "report/player.hpp"
#include "report/run_files.hpp"
#include "report/sections.hpp"
#include "report/summary_picture.hpp"
#include "write/atomic_file.hpp"

namespace gaussdrift::report {

namespace fs = std::filesystem;

namespace {

/// A file that cannot be written is named at the end.
void write_file(const fs::path& file, const std::string& text, ReportFiles& result) {
  try {
    write::write_text(file, text);
    result.written.push_back(file);
  } catch (const FileError& error) {
    result.failed.push_back(error.what());
  }
}

/// The page while it is made, and what it does without.
class Page {
 public:
  Page(const fs::path& folder, const json& summary) : folder_(folder), summary_(summary) {
    try {
      provenance_ = base::json_if_there(folder / "provenance.json", base::most_json_of_numbers, "it is left out")
                        .value_or(json());
    } catch (const FileError& error) {
      by_choice_.push_back(fmt::format("how the run was made: {}", error.what()));
    }
  }

  ReportFiles write(Pictures pictures, const PageSpec& wish) {
    std::error_code ignored;
    fs::remove(folder_ / summary_picture, ignored);  // an older one must not pass for this
    if (pictures == Pictures::drawn)
      shown_part_ = draw_summary(folder_, summary_, result_);
    else
      by_choice_.push_back(pictures == Pictures::later
                               ? fmt::format("pictures: there was no time to draw them when the run was stopped; "
                                             "gaussdrift report {} draws them",
                                             base::shell_word(folder_.string()))
                               : "pictures: the case wants none (output.images); gaussdrift report draws them all the "
                                 "same");
    add_head();
    if (const auto reel = reel_of_run(folder_, wish, by_choice_)) text_ += player_section(*reel, summary_);
    add_picture();
    add_errors();
    text_ += particles(summary_);
    text_ += seconds(summary_);
    if (const json frames = summary_.at("frames"); !frames.empty())
      text_ += "<h2>Conservation</h2><div class=scroll>" + conservation(frames) + "</div>\n";
    if (const json checks = get(summary_, "checks"); !checks.empty()) text_ += checks_table(checks);
    text_ += linked_files(folder_);
    const std::vector<std::string> absent = what_is_absent();
    add_absent(absent);
    add_origin();
    write_file(folder_ / "report.html", text_, result_);

    json report = summary_;
    report["not_on_the_page"] = absent;
    if (provenance_.is_object()) report["provenance"] = provenance_;
    write_file(folder_ / "report.json", report.dump(2, ' ', false, json::error_handler_t::replace) + "\n", result_);
    return std::move(result_);
  }

 private:
  json last() const {
    const json frames = summary_.at("frames");
    return frames.empty() ? json::object() : frames.back();
  }

  void add_head() {
    const std::string name = summary_.at("case").get<std::string>(), title = summary_.at("title").get<std::string>();
    text_ = fmt::format(
        "<!doctype html>\n<html lang=en><meta charset=utf-8><meta name=viewport "
        "content=\"width=device-width,initial-scale=1\">"
        // Nothing on the page can ask anybody for anything.
        "<meta http-equiv=Content-Security-Policy content=\"default-src 'none';img-src data:;style-src "
        "'unsafe-inline';script-src 'unsafe-inline'\">"
        "<title>{0}</title><style>{1}</style>\n<h1>{0}</h1><p class=quiet>{2}, by gaussdrift {3}</p>\n<p "
        "class=verdict id=verdict>{4}</p>\n",
        escaped(title.empty() ? name : title), render::frame_style() + page_file("page.css") + render::chart_style(),
        escaped(name),
        escaped(get(provenance_, "version").is_string() ? provenance_.at("version").get<std::string>() : ""),
        verdict(summary_));
    if (const json complete = get(summary_, "complete"); complete.is_boolean() && !complete.get<bool>())
      text_ +=
          "<p class=warning><b>This run is not complete.</b> The page shows what there is so far. <code>gaussdrift "
          "resume</code> goes on.</p>\n";
    for (const json& warning : get(summary_, "warnings"))
      text_ += fmt::format("<p class=warning><b>Warning:</b> {}</p>\n", escaped(warning.get<std::string>()));
  }

  void add_picture() {
    const fs::path file = folder_ / summary_picture;
    if (std::find(result_.written.begin(), result_.written.end(), file) == result_.written.end()) return;
    const std::string picture = read_file_of_run(file);
    if (picture.empty()) return;
    text_ += fmt::format(
        "<p><img alt=\"the densities of the first, the middle and the last output, the tracks if there are some, the "
        "exact one and the error where "
        "they are known, and the change\" src=\"data:image/png;base64,{}\"></p>\n",
        base64(picture));
    if (!shown_part_.empty()) text_ += fmt::format("<p class=quiet>{}</p>\n", escaped(shown_part_));
    if (const json untraced = get(last(), "untraced"); untraced.is_number() && untraced > 0)
      text_ += "<p class=quiet>Red in the exact density and grey in the error: points where it is not known.</p>\n";
  }

  /// Over time, by cause, and what digits of the sum cost.
  void add_errors() {
    const bool compared = last().contains("Linf");
    if (compared) {
      const std::string curves = error_curves(summary_.at("frames"));
      text_ += fmt::format("<h2>Error over time</h2><p>{}</p>{}\n", about_comparison(summary_, last()), curves);
      if (!curves.empty()) text_ += "<script>\n" + render::chart_script() + "</script>\n";
      if (curves.empty()) by_choice_.push_back("a curve of the error over time: the run was compared at one time only");
    } else {
      by_choice_.push_back("errors: the density was compared with nothing (reference.kind)");
    }
    if (summary_.contains("budget"))
      text_ += "<h2>Where the error comes from</h2>" + budget_table(summary_.at("budget")) + "\n";
    else if (compared)
      by_choice_.push_back("where the error comes from: accuracy.budget = \"none\"");
    if (!get(summary_, "accuracy_table").empty())
      text_ += accuracy_table(summary_);
    else if (const json why = get(summary_, "accuracy_table_left_out"); why.is_string())
      by_choice_.push_back("what digits of the sum cost: " + why.get<std::string>());
  }

  std::vector<std::string> what_is_absent() const {
    std::vector<std::string> absent = result_.left_out;
    for (const std::string& why : result_.failed) absent.push_back("pictures: " + why);
    absent.insert(absent.end(), by_choice_.begin(), by_choice_.end());
    return absent;
  }

  void add_absent(const std::vector<std::string>& absent) {
    if (absent.empty()) return;
    text_ += "<h2>What is not on this page</h2><ul>";
    for (const std::string& what : absent) text_ += "<li>" + escaped(what) + (what.ends_with('.') ? "" : ".");
    text_ += "</ul>\n";
  }

  /// The case, and how the run was made.
  void add_origin() {
    if (const std::string resolved = read_file_of_run(folder_ / "run.toml"); !resolved.empty())
      text_ += "<h2>The case, with all defaults</h2><pre>" + escaped(resolved) + "</pre>\n";
    if (provenance_.is_object()) text_ += how_to_make_again(provenance_);
    text_ += "</html>\n";
  }

  const fs::path folder_;
  const json& summary_;
  json provenance_;  // null where there is none
  std::string text_;
  std::string shown_part_;  // by the picture
  ReportFiles result_;
  std::vector<std::string> by_choice_;  // what the case did without, and what the folder lacks
};

}  // namespace

ReportFiles write_report(const fs::path& folder, Pictures pictures, const PageSpec& wish) {
  constexpr const char* remedy = "run the case again";
  const fs::path file = folder / "summary.json";
  const auto summary = base::json_if_there(file, base::most_json_of_numbers, remedy);
  if (!summary)
    throw FileError(
        fmt::format("{} holds no numbers of a run yet: there is no summary.json. gaussdrift resume begins a run again "
                    "that was killed",
                    folder.string()));
  for (const char* name : {"frames", "title", "case", "effects"})
    if (!summary->contains(name))
      throw FileError(fmt::format("{} is damaged: it does not tell {}; {}", file.string(), name, remedy));
  try {
    return Page(folder, *summary).write(pictures, wish);
  } catch (const json::exception&) {
    throw FileError(
        fmt::format("{} is damaged: a member of it has another type than it should; {}", file.string(), remedy));
  }
}

}  // namespace gaussdrift::report
