// The folder of a run: who writes into it, how far the run is, which files are its own, and what becomes of an earlier run.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gaussdrift/case.hpp"
#include "gaussdrift/frame.hpp"
#include "write/folder_lock.hpp"
#include "write/own_files.hpp"
#include "write/part_file.hpp"

namespace gaussdrift::write {

struct RunFolderOptions {
  bool force = false;                         // an earlier run is replaced
  bool go_on = false;                         // the run in the folder goes on: nothing is replaced
  double bytes = 0;                           // that the run will write, as predicted
  std::size_t particle_pieces = 1;            // of an output, at most
  std::vector<std::string> films{};           // of an animation, "images/surface.gif"
  std::vector<std::string> picture_styles{};  // that there are: runs of versions without status.json are known by them
};

/// Holds the folder for this process. status.json tells others how far the run is and which files are its own; no other
/// file is replaced or removed, and no link is followed. An earlier run is moved into the folder earlier/ and removed when
/// the first output of this one is there. All functions throw FileError with the remedy.
class RunFolder {
 public:
  RunFolder(std::filesystem::path folder, const Case& spec, const RunFolderOptions& options);
  /// A run that has told no end has failed.
  ~RunFolder();
  RunFolder(const RunFolder&) = delete;
  RunFolder& operator=(const RunFolder&) = delete;

  /// Of every output. It must be the last observer, because it says that the output is there.
  std::unique_ptr<Observer> watch();
  void complete() { end("complete", "open report.html, or density.pvd in ParaView"); }
  void interrupted(const std::string& next) { end("interrupted", next); }
  /// An earlier run is still in earlier/.
  bool keeps_earlier() const { return keeps_earlier_; }

 private:
  class Watch;
  void refuse_strangers(const OwnFiles& listed, const char* whose) const;
  void set_aside(const OwnFiles& earlier, bool has_outputs, bool lists_itself);
  void seen(double time);
  void begin();
  void fail();
  void end(const std::string& state, const std::string& next);
  std::string status_text(const std::string& state, const std::string& next) const;
  void tell(const std::string& state, const std::string& next) const;
  void keep_room_for_last_word();
  bool tell_without_room(const std::string& state, const std::string& next);

  const std::filesystem::path folder_;
  std::optional<FolderLock> lock_;
  OwnFiles own_;
  std::size_t outputs_ = 0;
  std::optional<double> time_;  // of the last output
  bool keeps_earlier_ = false, ended_ = false;
  std::optional<PartFile> spare_;  // room for the last status.json, on a disk that is full by then
  std::size_t spare_bytes_ = 0;
};

/// Puts more files onto the list of the run in that folder, before they are written. Throws FileError where one is there
/// that is not on the list. A run without a list, of an earlier version, has none. The caller holds the lock.
void add_to_own_files(const std::filesystem::path& folder, const std::vector<std::string>& names);

/// case.toml (as it was), run.toml (resolved), view.py (opens the series in ParaView). Throws FileError.
void write_run_inputs(const std::filesystem::path& folder, const Case& spec, const std::string& resolved);

}  // namespace gaussdrift::write
