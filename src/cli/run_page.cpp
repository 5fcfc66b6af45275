#include "cli/run_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <new>

#include "base/shell_word.hpp"
#include "report/page.hpp"

namespace gaussdrift::cli {

namespace fs = std::filesystem;

std::string write_page(const fs::path& folder, const Case& spec, OwedFiles& owed, bool pictures_come_later) {
  const bool pictures = !spec.output.images.empty(), later = pictures && pictures_come_later;
  const std::string remedy = fmt::format("gaussdrift report {} makes it later", base::shell_word(folder.string()));
  std::string without;
  if (later)
    without += fmt::format("page   without pictures for now: gaussdrift report {} draws them\n",
                           base::shell_word(folder.string()));
  try {
    const report::ReportFiles page = report::write_report(folder,
                                                          later      ? report::Pictures::later
                                                          : pictures ? report::Pictures::drawn
                                                                     : report::Pictures::not_wanted,
                                                          spec.output.page);
    for (const std::string& what : page.left_out) without += fmt::format("page   without {}\n", what);
    const bool there =
        std::find(page.written.begin(), page.written.end(), folder / "report.html") != page.written.end();
    for (const std::string& why : page.failed)
      owed.miss(fmt::format("{}: {}; {}",
                            there ? "the page about this run is not complete" : "there is no page about this run", why,
                            remedy));
  } catch (const std::bad_alloc&) {
    owed.miss_for_lack_of_memory("there is no page about this run: out of memory; " + remedy);
  } catch (const std::exception& error) {  // what was computed stands in the other files, and its checks count
    owed.miss(fmt::format("there is no page about this run: {}; {}", error.what(), remedy));
  }
  return without;
}

}  // namespace gaussdrift::cli
