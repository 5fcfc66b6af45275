#include "write/result_folder.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <nlohmann/json.hpp>
#include <optional>
#include <system_error>
#include <utility>

#include "base/json_file.hpp"
#include "gaussdrift/error.hpp"
#include "write/atomic_file.hpp"
#include "write/folder_names.hpp"
#include "write/part_file.hpp"
#include "write/provenance.hpp"

namespace gaussdrift::write {

namespace fs = std::filesystem;
using json = nlohmann::ordered_json;

namespace {

struct FolderStatus {
  std::string kind;
  bool has_result = false, is_set_aside = false;
  OwnFiles files;
};

/// What status.json says. The folder may be a stranger's: what has another type than it should is as if it were not there.
std::optional<FolderStatus> status_in(const fs::path& folder) {
  const auto there =
      base::json_if_there(folder / status_name, base::most_json_of_names, "choose another folder with --out");
  if (!there) return {};
  const json& all = *there;
  try {
    FolderStatus status{.kind = all.at("kind").get<std::string>(),
                        .has_result = all.value("has_result", true),
                        .is_set_aside = all.value("set_aside", false),
                        .files = {}};
    for (const json& name : all.at("files")) status.files.add(name.get<std::string>());
    return status;
  } catch (const json::exception&) {
    return {};
  }
}

void write_status(const fs::path& folder, const json& status) {
  write_text(folder / status_name, status.dump(2, ' ', false, json::error_handler_t::replace) + "\n");
}

bool is_there(const fs::path& folder) {
  std::error_code ignored;
  return fs::exists(folder, ignored);
}

/// The list last: a process that is killed in between can be followed by another.
void remove_results(const fs::path& folder, const OwnFiles& files) {
  files.remove_from(folder);
  OwnFiles({status_name}).remove_from(folder);
}

}  // namespace

ResultFolder::ResultFolder(fs::path folder, std::string kind, Earlier earlier, const OwnFiles& without_list)
    : folder_(std::move(folder)), kind_(std::move(kind)), made_(!is_there(folder_)), lock_(folder_) {
  std::error_code problem;
  if (fs::is_symlink(fs::symlink_status(folder_ / earlier_name, problem)))
    refuse(folder_, "earlier in it is a link, and links are not followed");
  const auto status = status_in(folder_), aside = status_in(folder_ / earlier_name);
  if (status && status->kind != kind_)
    refuse(folder_, fmt::format("it holds results of another kind ({})", status->kind));
  if (!status && fs::exists(folder_ / "run.toml")) refuse(folder_, "it holds a run");
  earlier_ = status ? status->files : without_list;
  aside_ = aside && aside->kind == kind_ && aside->is_set_aside;
  if (earlier == Earlier::join) {
    own_ = earlier_;
    return;
  }
  const bool there = !earlier_.found_in(folder_).empty();
  if ((there || aside_) && earlier == Earlier::refuse)
    throw FileError(
        fmt::format("{} holds an earlier {}, or what is left of one; --force replaces it, --out DIR writes "
                    "elsewhere",
                    folder_.string(), kind_));
  replaces_ = there || (status && status->is_set_aside);
  if (!aside_ && !(status && status->is_set_aside) && fs::exists(folder_ / earlier_name) && replaces_ &&
      !fs::is_empty(folder_ / earlier_name, problem))
    refuse(folder_, "earlier in it is not of a " + kind_ + ", and the earlier one would be kept there; move it away");
  if (replaces_ && aside_ && status && !status->has_result) {  // died before its first result: the one before is kept
    remove_results(folder_, earlier_);
    earlier_ = {}, replaces_ = false;
  }
}

ResultFolder::~ResultFolder() {
  if (begun_ && !complete_) {
    try {
      tell("failed");
    } catch (const std::exception&) {
      // A disk that is full: status.json still says "running", and no process holds the lock.
    }
  }
  std::error_code not_empty;
  if (!made_ || begun_) return;
  fs::remove(folder_ / lock_name, not_empty);
  fs::remove(folder_, not_empty);
}

void ResultFolder::set_aside() {
  const fs::path aside = folder_ / earlier_name;
  if (aside_)
    if (const auto before = status_in(aside)) remove_results(aside, before->files);
  write_status(folder_, {{"kind", kind_}, {"set_aside", true}, {"files", earlier_.names()}});
  try {
    make_folder(aside);
  } catch (const std::system_error& error) {
    refuse(folder_, fmt::format("earlier in it cannot be made: {}", error.code().message()));
  }
  earlier_.move(folder_, aside);
  OwnFiles({status_name}).move(folder_, aside);
  aside_ = true;
}

fs::path ResultFolder::claim(const std::string& name) {
  claim(std::vector{name});
  return folder_ / name;
}

void ResultFolder::claim(const std::vector<std::string>& names) {
  if (!begun_ && replaces_) set_aside();
  begun_ = true;
  std::error_code ignored;
  bool more = false;
  for (const std::string& name : names)
    if (!own_.has(name) && fs::exists(fs::symlink_status(folder_ / name, ignored)))
      refuse(folder_,
             fmt::format("{} in it is no file of an earlier {} and would be replaced; move it away", name, kind_));
  for (const std::string& name : names) {
    if (own_.has(name)) continue;
    own_.add(name);
    more = true;
  }
  if (more) tell("running");
}

void ResultFolder::has_result() {
  if (has_result_) return;
  has_result_ = true;
  tell("running");
  if (!aside_) return;
  const fs::path aside = folder_ / earlier_name;
  if (const auto before = status_in(aside)) remove_results(aside, before->files);
  std::error_code not_empty;  // a user's file in it stays
  fs::remove(aside, not_empty);
  aside_ = false;
}

void ResultFolder::complete() {
  tell("complete");
  complete_ = true;
}

void ResultFolder::tell(const std::string& state) const {
  write_status(folder_, {{"kind", kind_},
                         {"format", 1},
                         {"state", state},
                         {"has_result", has_result_},
                         {"version", program_version()},
                         {"pid", getpid()},
                         {"host", host_name()},
                         {"files", own_.names()}});
}

}  // namespace gaussdrift::write
