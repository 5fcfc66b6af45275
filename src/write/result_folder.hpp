// The folder of results that are no run's: of a study, of `reproduce`. As RunFolder does for runs, it keeps others out,
// knows its own files, and keeps earlier results until there are new ones.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "write/folder_lock.hpp"
#include "write/own_files.hpp"

namespace gaussdrift::write {

/// status.json has kind, state and list of files. All functions throw FileError with the remedy.
class ResultFolder {
 public:
  enum class Earlier {
    refuse,   ///< another folder has to be chosen
    replace,  ///< they are moved into earlier/ with the first result, and removed once that is there
    join      ///< they stay; each may be replaced by one of its name
  };
  /// Locks the folder; it stays as it is until the first result. `kind`: "study". `without_list`: files of earlier
  /// results in folders of versions that wrote no list.
  ResultFolder(std::filesystem::path folder, std::string kind, Earlier earlier, const OwnFiles& without_list = {});
  /// What has begun and is not complete has failed.
  ~ResultFolder();
  ResultFolder(const ResultFolder&) = delete;
  ResultFolder& operator=(const ResultFolder&) = delete;

  /// To be called before a file of this name is written: puts it on the list. Refuses one that is there and was not written by
  /// these or earlier results. Returns its path.
  std::filesystem::path claim(const std::string& name);
  /// The same for many.
  void claim(const std::vector<std::string>& names);
  /// A claimed file is there: earlier results are removed.
  void has_result();
  void complete();

 private:
  void set_aside();
  void tell(const std::string& state) const;

  const std::filesystem::path folder_;
  const std::string kind_;
  const bool made_;  // the folder was not there before
  FolderLock lock_;
  OwnFiles earlier_, own_;
  bool replaces_ = false, begun_ = false, aside_ = false, has_result_ = false, complete_ = false;
};

}  // namespace gaussdrift::write
