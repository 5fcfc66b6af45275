#include "write/run_folder.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <ctime>
#include <functional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "base/json_file.hpp"
#include "gaussdrift/error.hpp"
#include "sim/grid_pieces.hpp"
#include "write/atomic_file.hpp"
#include "write/checkpoint.hpp"
#include "write/folder_names.hpp"
#include "write/output_files.hpp"
#include "write/provenance.hpp"
#include "write/series_table.hpp"
#include "write/track_files.hpp"
#include "write/view_script.hpp"

namespace gaussdrift::write {

namespace fs = std::filesystem;
using json = nlohmann::ordered_json;

namespace {

constexpr std::size_t most_names = 40'000;  // in status.json, and as many as most_json_of_names has room for

/// In how many pieces an output may be written.
struct Pieces {
  std::size_t of_density = 1, of_particles = 1;
};

/// The files that a run writes: series of these kinds, `most` files each.
OwnFiles files_of_run(const std::vector<std::string>& kinds, const std::vector<std::string>& picture_styles,
                      std::size_t most, const Pieces& pieces) {
  OwnFiles files({"case.toml", "log.txt", "provenance.json", "report.frames", "report.html", "report.json", "run.toml",
                  series_name, "summary.json", "summary.png", "view.py"});
  for (const std::string& name : names_in_state(most)) files.add(name);
  for (const std::string& name : kinds) {
    files.add(name + ".pvd");
    const FileKind& kind = find_output_file(name);
    const std::string numbered = name + "/" + name + "_";
    const bool pieces_for_certain = kind.piece && pieces.of_density > 1;
    if (!pieces_for_certain) files.add(numbered_names(numbered, most, kind.ending));
    const std::size_t count = pieces_for_certain ? pieces.of_density : kind.particle_piece ? pieces.of_particles : 1;
    if (count <= 1) continue;
    files.add(numbered_names(numbered, most, kind.index_ending));
    files.add(numbered_names(numbered_names(numbered, most, "/"), count, kind.ending));
  }
  for (const std::string& style : picture_styles) files.add(numbered_names("images/" + style + "_", most, ".png"));
  return files;
}

OwnFiles files_of(const Case& spec, const RunFolderOptions& options) {
  std::vector<std::string> kinds, styles;
  for (const OutputFile& file : spec.output.files) kinds.emplace_back(file.name);
  for (const PictureStyle& style : spec.output.images) {
    const std::string& field = spec.output.pictures.field;
    styles.push_back(field.empty() ? std::string(style.name) : fmt::format("{}_{}", field, style.name));
    for (const TracerSpec& tracer : spec.tracers) styles.push_back(fmt::format("{}_{}", tracer.name, style.name));
  }
  OwnFiles files =
      files_of_run(kinds, styles, spec.output.times.size(), {pieces_of_grid(spec).count(), options.particle_pieces});
  for (const std::string& film : options.films) files.add(film);
  if (spec.output.animation)
    files.add(
        numbered_names("state/animation/frame_", static_cast<std::size_t>(spec.output.animation->frames), ".raw"));
  for (const std::string& name : track_file_names(spec.output)) files.add(name);
  return files;
}

/// Of a version that wrote no list, and no pieces.
OwnFiles files_without_list(const std::vector<std::string>& picture_styles) {
  std::vector<std::string> kinds;
  for (const FileKind& kind : output_files()) kinds.emplace_back(kind.about.name);
  return files_of_run(kinds, picture_styles, most_outputs, {});
}

/// What status.json says. The folder may be a stranger's. Throws FileError if the file is damaged: which files are the
/// run's own is then not known.
struct Status {
  explicit Status(const fs::path& folder) {
    constexpr const char* remedy = "remove it if the files beside it are of a run";
    const fs::path file = folder / status_name;
    const auto told = base::json_if_there(file, base::most_json_of_names, remedy);
    if (!told || told->value("kind", json()) != "run") return;
    try {
      const json& names = told->at("files");
      if (names.size() > most_names)
        throw FileError(
            fmt::format("{} is damaged: it lists more than {} files; {}", file.string(), most_names, remedy));
      for (const json& name : names) files.add(name.get<std::string>());
      const json &count = told->at("outputs"), &last = told->at("last_output");
      if (!count.is_number_unsigned())
        throw FileError(fmt::format("{} is damaged: outputs is no count; {}", file.string(), remedy));
      outputs = count.get<std::size_t>();
      is_set_aside = told->value("set_aside", false);
      if (last.is_number()) time = last.get<double>();
    } catch (const json::exception&) {
      throw FileError(fmt::format("{} is damaged: a member is missing or has another type than it should; {}",
                                  file.string(), remedy));
    }
    all = *told;
    there = true;
  }
  bool there = false, is_set_aside = false;
  OwnFiles files;
  std::size_t outputs = 0;
  std::optional<double> time;
  json all;
};

std::string text_of(const json& status) { return status.dump(2, ' ', false, json::error_handler_t::replace) + "\n"; }

/// Left by a process that was killed, this version's or an earlier one's: nothing is lost with it.
bool is_leftover(const std::string& name) { return name == lock_name || name == "run.toml.part" || is_part_name(name); }

/// The nearest folder above that is there tells how much is free.
void check_space(const fs::path& folder, double bytes, double freed) {
  fs::path there = fs::absolute(folder);
  std::error_code problem;
  while (!fs::exists(there, problem) && there.has_relative_path()) there = there.parent_path();
  const fs::space_info space = fs::space(there, problem);
  if (problem || static_cast<double>(space.available) + freed >= bytes) return;
  throw FileError(
      fmt::format("the run will write about {:.3g} MB, and {:.3g} MB are free for {}; free some space, write fewer "
                  "outputs or files "
                  "(output.times, output.vtk, output.images), or choose another folder with --out",
                  bytes / 1e6, static_cast<double>(space.available) / 1e6, folder.string()));
}

std::string now() {
  const std::time_t time = std::time(nullptr);
  std::tm parts{};
  gmtime_r(&time, &parts);
  return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}Z", parts.tm_year + 1900, parts.tm_mon + 1, parts.tm_mday,
                     parts.tm_hour, parts.tm_min, parts.tm_sec);
}

/// Removes the files of a run, its list last: a process that is killed in between can be followed by another.
void remove_run(const fs::path& folder, const OwnFiles& files) {
  files.remove_from(folder);
  OwnFiles({status_name}).remove_from(folder);
}

/// Folders of a run, also of one that is kept in earlier/, and folders in them: what is written or moved there must not
/// go elsewhere. A link in place of a file is replaced itself. What else is in the folder is not looked at.
void check_links(const fs::path& folder) {
  std::error_code ignored;
  const std::function<void(const fs::path&, int)> check = [&](const fs::path& name, int inner) {
    if (fs::is_symlink(fs::symlink_status(folder / name, ignored)))
      refuse(folder, fmt::format("{} in it is a link, and links are not followed; remove the link", name.string()));
    if (inner == 0 || !fs::is_directory(folder / name, ignored)) return;
    std::error_code problem;
    for (auto entry = fs::directory_iterator(folder / name, problem); !problem && entry != fs::directory_iterator();
         entry.increment(problem))
      if (entry->is_directory(ignored)) check(name / entry->path().filename(), inner - 1);  // or a link to one
  };
  std::vector<std::string> folders{"images", checkpoints_folder};
  for (const FileKind& kind : output_files()) folders.emplace_back(kind.about.name);
  for (const std::string& name : folders) check(name, 1);
  check(earlier_name, 2);
}

}  // namespace

RunFolder::RunFolder(fs::path folder, const Case& spec, const RunFolderOptions& options)
    : folder_(std::move(folder)), own_(files_of(spec, options)) {
  std::error_code problem;
  const fs::file_status status = fs::status(folder_, problem);
  if (fs::exists(status) && !fs::is_directory(status)) refuse(folder_, "it is a file");
  if (!fs::exists(status)) check_space(folder_, options.bytes, 0);
  lock_.emplace(folder_);
  check_links(folder_);
  const Status run(folder_), aside(folder_ / earlier_name);
  const bool old_version = !run.there && fs::exists(folder_ / "run.toml");
  const OwnFiles files = old_version ? files_without_list(options.picture_styles) : run.files;
  keeps_earlier_ = aside.is_set_aside;
  if (options.go_on) {
    if (run.there) refuse_strangers(files, "the run");
    for (const std::string& name : files.names()) own_.add(name);
    outputs_ = run.outputs, time_ = run.time;
    check_space(folder_, options.bytes, own_.bytes_in(folder_));
    keep_room_for_last_word();
    begin();
    return;
  }

  bool empty = true, nothing_else = true;  // but the run's own
  for (const auto& entry : fs::directory_iterator(folder_, problem)) {
    const std::string name = entry.path().filename().string();
    if (is_leftover(name)) continue;
    empty = false;
    nothing_else = nothing_else && (files.has(name) || name == status_name);
  }
  if (problem) refuse(folder_, problem.message());
  const bool killed_at_once = run.there && run.outputs == 0 && !run.is_set_aside && !keeps_earlier_ && nothing_else &&
                              checkpoint_files(folder_).empty();
  if (!empty && !killed_at_once && !options.force)
    throw FileError(fmt::format("{} is not empty; --force replaces the earlier run in it, --out DIR writes elsewhere",
                                folder_.string()));
  if (!empty && !run.there && !old_version && !keeps_earlier_)
    throw FileError(
        fmt::format("{} holds no earlier run (it has neither status.json nor run.toml), so --force does not touch it; "
                    "choose another folder with --out",
                    folder_.string()));
  // Empty: a process was killed after it had removed the run in it.
  if (fs::exists(folder_ / earlier_name) && !keeps_earlier_ && !run.is_set_aside &&
      !fs::is_empty(folder_ / earlier_name, problem))
    refuse(folder_, "earlier in it is not of a run, and an earlier run would be kept there; move it away");
  refuse_strangers(files, "the earlier run");
  check_space(folder_, options.bytes, files.bytes_in(folder_));
  keep_room_for_last_word();                       // without it the earlier run stays where it is
  fs::remove(folder_ / "run.toml.part", problem);  // of earlier versions, killed at once
  if (killed_at_once)
    remove_run(folder_, files);
  else
    set_aside(files, run.outputs > 0 || old_version, run.there);
  begin();
}

/// Files that would be replaced and are not on the list of `whose`.
void RunFolder::refuse_strangers(const OwnFiles& listed, const char* whose) const {
  for (const std::string& name : own_.found_in(folder_))
    if (!listed.has(name))
      refuse(folder_, fmt::format("{} in it is no file of {} and would be replaced; move it away", name, whose));
}

/// The run that is to be replaced goes into earlier/. Its list goes last: while it is at the top, a process that is killed
/// can be followed by another that moves the rest. A run without an output does not take the place of one that has some.
void RunFolder::set_aside(const OwnFiles& earlier, bool has_outputs, bool lists_itself) {
  if (!lists_itself && !has_outputs) return;  // nothing is there
  const fs::path aside = folder_ / earlier_name;
  if (keeps_earlier_ && !has_outputs) return remove_run(folder_, earlier);
  if (keeps_earlier_) remove_run(aside, Status(aside).files);
  json list = lists_itself ? Status(folder_).all : json{{"kind", "run"}, {"state", "unknown"}, {"outputs", 1}};
  list["set_aside"] = true;
  list["files"] = earlier.names();
  if (!list.contains("last_output")) list["last_output"] = nullptr;
  write_text(folder_ / status_name, text_of(list));
  try {
    make_folder(aside);
  } catch (const std::system_error& error) {
    refuse(folder_, fmt::format("earlier in it cannot be made: {}", error.code().message()));
  }
  earlier.move(folder_, aside);
  OwnFiles({status_name}).move(folder_, aside);
  keeps_earlier_ = true;
}

/// The name may be taken, and the disk may then refuse the folder.
void RunFolder::begin() {
  try {
    tell("running", "wait, or look at what is there: every file is whole");
  } catch (const FileError&) {
    if (fs::exists(folder_ / status_name)) fail();
    throw;
  }
}

RunFolder::~RunFolder() {
  if (!ended_) fail();
}

void RunFolder::fail() {
  try {
    const std::string next = "gaussdrift resume goes on, or run it again with --force";
    end("failed", keeps_earlier_ ? next + "; the earlier run is whole in the folder earlier" : next);
  } catch (const std::exception&) {
    // A disk that takes nothing at all: status.json still says "running", and no process holds the lock.
  }
}

void RunFolder::end(const std::string& state, const std::string& next) {
  try {
    tell(state, next);
  } catch (const FileError&) {
    if (!tell_without_room(state, next)) throw;
  }
  spare_.reset();
  ended_ = true;
}

std::string RunFolder::status_text(const std::string& state, const std::string& next) const {
  return text_of({{"kind", "run"},
                  {"format", 1},
                  {"state", state},
                  {"next", next},
                  {"outputs", outputs_},
                  {"last_output", time_ ? json(*time_) : json()},
                  {"written", now()},
                  {"version", program_version()},
                  {"pid", getpid()},
                  {"host", host_name()},
                  {"files", own_.names()}});
}

void RunFolder::tell(const std::string& state, const std::string& next) const {
  write_text(folder_ / status_name, status_text(state, next));
}

/// A disk that fills up has no room for another status.json, and the old one says "running". So there is a hidden file of
/// that size, which is filled in its place and takes the name.
void RunFolder::keep_room_for_last_word() {
  const std::size_t longest_next = 1000 + 6 * folder_.string().size();  // a letter may become \u0012
  const std::string room(status_text("running", "").size() + longest_next, '\n');
  try {
    spare_.emplace(folder_ / status_name);
    spare_->write_at(0, room);
    spare_->flush();
    spare_bytes_ = room.size();
  } catch (const std::system_error& error) {
    fail_to_write(folder_ / status_name, error.code().value());
  }
}

/// False if there is no room either.
bool RunFolder::tell_without_room(const std::string& state, const std::string& next) {
  std::string text = status_text(state, next);
  if (!spare_ || text.size() > spare_bytes_) return false;
  text.append(spare_bytes_ - text.size(), '\n');
  try {
    spare_->write_at(0, text);
    spare_->flush();
    spare_->take_name(folder_ / status_name);
    return true;
  } catch (const std::system_error&) {
    return false;
  }
}

void RunFolder::seen(double time) {
  ++outputs_;
  time_ = time;
  tell("running", "wait, or look at what is there: every file is whole");
  if (!keeps_earlier_) return;
  const fs::path aside = folder_ / earlier_name;
  remove_run(aside, Status(aside).files);
  std::error_code not_empty;  // a user's file in it stays
  fs::remove(aside, not_empty);
  keeps_earlier_ = false;
}

class RunFolder::Watch : public Observer {
 public:
  explicit Watch(RunFolder& folder) : folder_(folder) {}
  std::string name() const override { return "write status"; }
  bool needs_particles(double /*time*/) const override { return false; }
  void frame(const Frame& frame) override { folder_.seen(frame.time); }
  /// A run that was killed may have written outputs after its checkpoint. They are written again, and count once.
  void restore(const std::vector<std::pair<double, FrameNumbers>>& frames, const std::string& /*state*/) override {
    folder_.outputs_ = frames.size();
    folder_.time_ = frames.empty() ? std::nullopt : std::optional(frames.back().first);
  }

 private:
  RunFolder& folder_;
};

std::unique_ptr<Observer> RunFolder::watch() { return std::make_unique<Watch>(*this); }

void add_to_own_files(const fs::path& folder, const std::vector<std::string>& names) {
  check_links(folder);
  Status status(folder);
  if (!status.there) return;
  std::error_code ignored;
  for (const std::string& name : names)
    if (!status.files.has(name) && fs::exists(fs::symlink_status(folder / name, ignored)))
      throw FileError(
          fmt::format("{} is no file of the run in {} and would be replaced; move it away, or choose another "
                      "folder with --out",
                      (folder / name).string(), folder.string()));
  const std::size_t before = status.files.names().size();
  for (const std::string& name : names)
    if (!status.files.has(name)) status.files.add(name);
  if (status.files.names().size() == before) return;
  status.all["files"] = status.files.names();
  write_text(folder / status_name, text_of(status.all));
}

void write_run_inputs(const fs::path& folder, const Case& spec, const std::string& resolved) {
  if (!spec.source.empty()) write_text(folder / "case.toml", spec.source);
  write_text(folder / "run.toml", resolved);
  write_text(folder / "view.py", view_script(spec));
}

}  // namespace gaussdrift::write
