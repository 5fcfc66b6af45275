// gaussdrift resume: goes on with a run that was interrupted or killed, or with a complete one beyond its end.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/lies_in.hpp"
#include "base/number.hpp"
#include "base/text_file.hpp"
#include "cli/asked_case.hpp"
#include "cli/carry_out.hpp"
#include "cli/missing_files.hpp"
#include "cli/shared_task.hpp"
#include "cli/stop_request.hpp"
#include "cli/terminal.hpp"
#include "cli/verbs.hpp"
#include "gaussdrift/read_case.hpp"
#include "input/case_dates.hpp"
#include "input/same_past.hpp"
#include "write/folder_facts.hpp"

namespace gaussdrift::cli {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t largest_case = 4'000'000;  // bytes

struct ResumeOptions {
  fs::path folder{};
  std::string until{};                   // a new time.end, a number or a date; empty: the old one
  std::vector<std::string> overrides{};  // --set key=value
  std::string stop_after{};              // a length of time; empty: never
  std::string memory{};                  // --memory
  int threads = 0;                       // 0: all
  bool json = false;                     // results as JSON on standard output
  std::string command{};                 // as it was typed
};

void declare(OptionList& options, ResumeOptions& given) {
  options.add("folder", given.folder, "DIR", "folder of a run").required();
  options.add("--until", given.until, "T", "a new end, time.end, a time or a date. Outputs go on at the same distance");
  options
      .add("--set", given.overrides, "KEY=VALUE",
           "change a key that does not change the past, such as output.times. Repeatable")
      .repeatable();
  declare_stop_after(options, given.stop_after);
  declare_memory(options, given.memory);
  options.threads(given.threads);
  options.json(given.json);
}

/// Of the case as it was run, which run.toml does not say: pictures without a title show it.
std::string name_of(const fs::path& folder) {
  const std::string name = write::name_of_run(folder);
  return name.empty() ? fs::absolute(folder).filename().string() : name;
}

Case case_in(const fs::path& folder, const std::vector<std::string>& overrides, int threads) {
  for (const char* name : {"run.toml", "case.toml"})
    if (!base::lies_in(folder / name, folder))
      throw FileError(fmt::format(
          "{} is a link out of the folder of the run, and such links are not followed; put the file itself there",
          (folder / name).string()));
  if (!fs::exists(folder / "run.toml"))
    throw FileError(fmt::format("{} holds no run that has begun (it has no run.toml), so there is nothing to resume",
                                folder.string()));
  Case spec = read_case(folder / "run.toml", overrides, threads).spec;
  spec.name = name_of(folder);
  spec.source.clear();  // case.toml stays as it is
  return spec;
}

/// Outputs up to a later end: at the distance of the last two, and at the end itself.
void add_outputs(Case& spec, double old_end) {
  std::vector<double>& times = spec.output.times;
  const double end = spec.time.end;
  if (end <= old_end || times.empty()) return;
  const double first = times.back(), apart = times.size() > 1 ? first - times[times.size() - 2] : 0;
  constexpr double most = 1e6;
  if (apart > 0 && (end - first) / apart < most)
    for (std::size_t i = 1; first + static_cast<double>(i) * apart < end * (1 - 1e-9); ++i)
      times.push_back(first + static_cast<double>(i) * apart);
  if (times.back() < end) times.push_back(end);
}

/// What was written stays; what is to come is that of the case as it is now. Returns what was asked for and cannot come
/// any more.
std::vector<double> keep_written_outputs(const Case& before, double now, Case& spec) {
  std::vector<double> times, too_late;
  const std::vector<double>& written = before.output.times;
  for (const double time : written)
    if (time < now) times.push_back(time);
  for (const double time : spec.output.times)
    if (time >= now)
      times.push_back(time);
    else if (std::find(written.begin(), written.end(), time) == written.end())
      too_late.push_back(time);
  spec.output.times = std::move(times);
  return too_late;
}

std::string words_of_late_outputs(const std::vector<double>& times, double now, const TimeSpec& clock) {
  if (times.empty()) return "";
  const bool one = times.size() == 1;
  return fmt::format("warning: no output at t = {:.6g}{}: the run is at t = {:.6g} already\n", clock.at(times.front()),
                     one ? "" : fmt::format(" and at {} more times that were asked for", times.size() - 1),
                     clock.at(now));
}

/// Outputs that the run has, as far as its checkpoint knows of them.
std::size_t outputs_until(const Case& spec, double now, const fs::path& folder) {
  const auto& times = spec.output.times;
  const auto past = std::count_if(times.begin(), times.end(), [&](double time) { return time <= now; });
  return std::min(static_cast<std::size_t>(past), write::outputs_of_folder(folder));
}

void refuse_changed_past(const input::ChangedKeys& changed) {
  if (changed.past.empty()) return;
  throw InputError(fmt::format(
      "{} cannot change while a run is under way, because what was computed depends on {}. Outputs from now on, "
      "pictures, checks, titles, time.end and threads can. Start a new run for the rest.",
      fmt::join(changed.past, ", "), changed.past.size() == 1 ? "it" : "them"));
}

/// Its numbers are complete, and status.json says that what comes after them is not. Earlier versions wrote no status.json.
bool lacks_its_end(const fs::path& folder) {
  const std::string state = write::state_of_folder(folder);
  return !state.empty() && state != "complete";
}

/// The run as it was, and as it is asked for.
struct Asked {
  Case before{}, spec{};
  std::string past{};
  double stop_after = 0, most_memory = 0;
};

/// A time of the clock, as a number or a date of the case's data.
double time_named(const std::string& text, const Case& spec) {
  if (const auto number = base::read_number<double>(text)) return *number;
  if (const auto time = input::time_of_date(spec, text)) return *time;
  throw CommandLineError(fmt::format(
      "--until {} is no number{}", text,
      spec.time.date ? fmt::format(", and no date such as \"{}\"", spec.time.date(spec.time.at(spec.time.end)))
                     : ", and no data of this run have dates"));
}

Asked asked_for(const ResumeOptions& options) {
  Asked asked;
  asked.stop_after = stop_after_seconds(options.stop_after);
  asked.most_memory = most_memory(options.memory);
  asked.before = case_in(options.folder, {}, options.threads);
  const Case& before = asked.before;
  const bool times_set = std::any_of(options.overrides.begin(), options.overrides.end(), [](const std::string& set) {
    return set.starts_with("output.times") || set.starts_with("output.frames");
  });
  Case spec = case_in(options.folder, options.overrides, options.threads);
  if (!options.until.empty()) {
    const double end = spec.time.elapsed(time_named(options.until, spec));
    if (!std::isfinite(end) || end < 0)
      throw CommandLineError(fmt::format("--until {} is no time of this run, which goes from {} {}", options.until,
                                         spec.time.start, spec.time.backwards ? "backwards" : "on"));
    spec.time.end = end;
    std::erase_if(spec.output.times, [&](double time) { return time > spec.time.end; });
  }
  if (!times_set) add_outputs(spec, before.time.end);
  refuse_changed_past(input::changed_keys(before, spec));
  asked.spec = std::move(spec);
  asked.past = past_of(before);
  return asked;
}

/// Of a complete run: its end is made where it lacks.
ExitCode nothing_to_do(const fs::path& folder, const Case& spec) {
  if (lacks_its_end(folder)) {
    note("all numbers are there; the page about them is made again\n");
    return finish(spec, folder);
  }
  put(stdout, fmt::format("{} is complete. --until T lengthens it.\n", folder.string()));
  return ExitCode::ok;
}

RunTask task_of(const ResumeOptions& options, const Asked& asked, std::optional<write::Checkpoint> from,
                const std::vector<std::string>& refused) {
  RunTask task;
  task.stop_after = asked.stop_after;
  task.most_memory = asked.most_memory;
  const Case& before = asked.before;
  Case spec = asked.spec;
  task.folder = options.folder;
  task.command = options.command;
  task.json = options.json;
  task.threads = options.threads;
  task.past = asked.past;
  task.from = std::move(from);
  for (const std::string& why : refused) note("warning: {}\n", why);
  const bool complete = write::says_complete(options.folder);
  if (task.from) {
    const double now = task.from->facts.time;
    if (spec.time.end < now)
      throw InputError(fmt::format("time.end = {:g} lies before t = {:g}, where the last checkpoint is",
                                   spec.time.at(spec.time.end), spec.time.at(now)));
    task.told = words_of_late_outputs(keep_written_outputs(before, now, spec), now, spec.time);
    tell_missing_files(before, options.folder, outputs_until(before, now, options.folder));
  }
  if (complete && !task.from) tell_missing_files(before, options.folder, write::outputs_of_folder(options.folder));
  const std::vector<std::string> changed = input::changed_keys(before, spec).future;
  if (complete && changed.empty()) {
    task.done = nothing_to_do(options.folder, spec);
    return task;
  }
  if (complete && !task.from)
    throw InputError(
        fmt::format("{} is complete, and it keeps no checkpoint to go on from. Set output.checkpoint in a new run.",
                    options.folder.string()));
  task.changed = !changed.empty();
  if (task.changed) task.told += fmt::format("changed from now on: {}\n", fmt::join(changed, ", "));
  if (task.from)
    task.told += fmt::format("goes on at t = {:.6g} of {:.6g}, after {} steps: the last checkpoint\n",
                             spec.time.at(task.from->facts.time), spec.time.at(spec.time.end), task.from->facts.steps);
  else
    task.told += "there is no checkpoint; the run begins again\n";
  task.force = !task.from;
  task.goes_on = task.from.has_value();
  if (!task.from && fs::exists(options.folder / "case.toml"))
    spec.source = base::read_text_file(options.folder / "case.toml", "a case", largest_case);
  task.asked = spec;
  task.spec = std::move(spec);
  return task;
}

ExitCode resume(const ResumeOptions& options, base::Communicator& ranks) {
  const bool first = ranks.rank() == 0;
  Asked asked;
  ranks.agree_on([&] {
    if (first) asked = asked_for(options);
  });
  std::vector<std::string> refused;
  std::optional<write::Checkpoint> from = write::read_checkpoint(options.folder, asked.past, refused, ranks);
  RunTask task = shared_task(ranks, [&] { return task_of(options, asked, std::move(from), refused); });
  if (!first) task.from = std::move(from);
  return carry_out(std::move(task), ranks);
}

}  // namespace

Verb resume_verb(const std::string& typed) {
  return make_shared_verb<ResumeOptions>("resume", "go on with a run that was stopped or killed, or beyond its end",
                                         declare, resume, {.command = typed});
}

}  // namespace gaussdrift::cli
