// gaussdrift report: the page about a run, made again.
#include <optional>
#include <system_error>

#include "cli/laid_out.hpp"
#include "cli/outputs_of.hpp"
#include "cli/terminal.hpp"
#include "cli/verbs.hpp"
#include "report/page.hpp"
#include "write/folder_lock.hpp"

namespace gaussdrift::cli {

namespace fs = std::filesystem;

namespace {

struct ReportOptions {
  fs::path folder;
  bool json = false;
};

void declare(OptionList& options, ReportOptions& given) {
  options.add("folder", given.folder, "DIR", "folder of a run").required();
  options.json(given.json);
}

ExitCode report(const ReportOptions& options) {
  std::optional<write::FolderLock> lock;
  if (std::error_code ignored; fs::is_directory(options.folder, ignored)) lock.emplace(options.folder);
  tell_if_unfinished(options.folder, lock.has_value());
  const report::ReportFiles files = report::write_report(options.folder, report::Pictures::drawn);
  if (options.json) {
    nlohmann::ordered_json written = nlohmann::ordered_json::array();
    for (const fs::path& file : files.written) written.push_back(file.string());
    say("{}\n", laid_out({{"written", written}, {"left_out", files.left_out}}));
  } else {
    for (const fs::path& file : files.written) say("wrote  {}\n", file.string());
    for (const std::string& what : files.left_out) say("left out {}\n", what);
  }
  for (const std::string& why : files.failed) note("error: {}\n", why);
  return files.failed.empty() ? ExitCode::ok : ExitCode::files;
}

}  // namespace

Verb report_verb() {
  return make_verb<ReportOptions>("report", "make the page of a run again: report.html, report.json, summary.png",
                                  declare, report);
}

}  // namespace gaussdrift::cli
