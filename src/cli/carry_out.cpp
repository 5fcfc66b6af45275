#include "cli/carry_out.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <thread>
#include <utility>

#include "accuracy/footprint.hpp"
#include "accuracy/ranks_memory.hpp"
#include "base/counted.hpp"
#include "base/has_one.hpp"
#include "base/parallel.hpp"
#include "base/printable.hpp"
#include "base/process_stopwatch.hpp"
#include "base/seam.hpp"
#include "base/shell_word.hpp"
#include "base/size_text.hpp"
#include "base/stopwatch.hpp"
#include "cli/checkpoint_keeper.hpp"
#include "cli/common_ground.hpp"
#include "cli/films.hpp"
#include "cli/look_back.hpp"
#include "cli/owed_files.hpp"
#include "cli/progress.hpp"
#include "cli/rank_shares.hpp"
#include "cli/run_observers.hpp"
#include "cli/run_page.hpp"
#include "cli/run_words.hpp"
#include "cli/stop_request.hpp"
#include "cli/terminal.hpp"
#include "gaussdrift/accuracy.hpp"
#include "gaussdrift/read_case.hpp"
#include "input/data_files.hpp"
#include "input/same_past.hpp"
#include "render/styles.hpp"
#include "report/reel_series.hpp"
#include "sim/scene.hpp"
#include "write/atomic_file.hpp"
#include "write/provenance.hpp"
#include "write/run_folder.hpp"
#include "write/summary.hpp"

namespace gaussdrift::cli {

namespace fs = std::filesystem;

namespace {

/// Data files are named as seen from the run's folder.
std::vector<write::DataFile> data_of(const Case& spec, const fs::path& folder) {
  std::vector<write::DataFile> data;
  for (const fs::path& file : input::data_files(spec))
    data.push_back({folder.empty() ? file.string() : input::seen_from(folder, file).generic_string(), file});
  return data;
}

/// The hash has the bytes and bare names of data files: where they lie is of no interest to the result.
std::string provenance_of(const RunTask& task) {
  return write::provenance_json(task.spec, case_text(input::with_bare_names(task.spec)),
                                data_of(task.spec, task.folder), task.command, base::resolve_threads(task.threads));
}

/// Bytes that the run will write.
double disk_of(const Case& spec, const Simulation& simulation, int threads) {
  return accuracy::most_disk_of_run(spec,
                                    {.particles = static_cast<double>(simulation.particle_count()),
                                     .grid_points = static_cast<double>(evaluation_lattice(spec).size()),
                                     .compared_everywhere = simulation.compares_everywhere()},
                                    simulation.rough_seconds() / base::resolve_threads(threads));
}

class Run {
 public:
  Run(RunTask& task, base::Communicator& ranks)
      : task_(task), spec_(task.spec), folder_(task.folder), ranks_(ranks), first_(ranks.rank() == 0) {}

  /// All ranks: what they need to have in common, before anything is written.
  void check_common_ground() {
    check_that_all_see(ranks_, folder_);
    if (std::string why = warning_of_different_arithmetic(ranks_, arithmetic_here()); !why.empty()) {
      note("warning: {}\n", why);
      told_.push_back(std::move(why));
    }
  }

  /// All ranks. False if it was stopped before it could go on.
  bool simulate() {
    const base::Stopwatch preparing;
    std::optional<Simulation> made;
    accuracy::refuse_what_does_not_fit(spec_, task_.threads, task_.most_memory, ranks_);
    ranks_.agree_on([&] { made.emplace(spec_, task_.threads, ranks_); });
    Simulation& simulation = *made;
    simulation.prepare();  // what cannot begin must not cost an earlier run
    // A signal before has ended the program at once: there was nothing to save.
    stop_.emplace(task_.stop_after - preparing.seconds());
    ranks_.agree_on([&] {
      if (first_)
        prepare_to_write(simulation);
      else
        observe_pieces(simulation, spec_, folder_);
      keep_checkpoints();
    });
    simulation.abandon_when([this] { return stop_->by_signal() || (moved_on_ && stop_->made()); });
    try {
      if (task_.goes_on) simulation.restore(std::move(task_.from->particles), task_.from->state);
    } catch (const Abandoned&) {
      is_to_stop();  // all ranks know why
      if (first_) own_folder_->interrupted(how_to_go_on());
      return false;
    }
    ProgressLine line;
    simulation.on_progress([&](const Progress& progress) {
      if (first_) line.show(progress);
      moved_on_ = true;
      if (is_to_stop() && progress.elapsed < progress.length) return false;
      std::int64_t keeps = first_ && keeper_->is_time(progress);
      ranks_.max(std::span(&keeps, 1));
      if (keeps) keep(simulation, progress.elapsed, progress.steps_done);
      return !keeps || !is_to_stop() || progress.elapsed >= progress.length;  // so it is the last one
    });
    try {
      const base::ProcessStopwatch running;
      summary_ = simulation.run();
      share_seconds_ = running.seconds();
      if (!complete()) {
        is_to_stop();  // all ranks know why, also where something was abandoned
        keep(simulation, summary_.elapsed, summary_.steps);
      }
    } catch (const FileError& error) {  // a full disk, mostly
      if (ranks_.size() > 1 && !ranks_.failed_together(std::current_exception())) throw;
      keep_what_there_is(simulation);
      ranks_.agree_on([&] { throw FileError(fmt::format("{}\n{}", error.what(), how_to_go_on())); });
    }
    return true;
  }

  /// All ranks: how evenly they worked.
  void gather_shares() { shares_ = cli::gather_shares(ranks_, share_seconds_); }

  bool complete() const { return summary_.complete; }

  void explain_errors() {
    if (complete()) judge_errors();
    // The budget tells whether gaps between blobs matter.
    std::optional<double> quadrature;
    if (budget_ && budget_->known()) quadrature = budget_->quadrature;
    std::vector<std::string> warnings = warnings_of(spec_, summary_, quadrature);
    warnings.insert(warnings.end(), of_observers_.begin(), of_observers_.end());
    warnings_.insert(warnings_.begin(), warnings.begin(), warnings.end());
  }

  /// After the last word: what was written in haste goes to the disk, as far as there is time. The system writes the
  /// rest.
  void force_checkpoint() {
    if (!keeper_) return;
    constexpr double most = 1.5;  // seconds after the signal
    ranks_.agree_on([&] { keeper_->force([this] { return stop_->seconds_since_signal() > most; }); });
  }

  ExitCode tell_how_to_go_on() const {
    note("{}\n", how_to_go_on());
    return stop_code();
  }

  /// Every file before the first word: a terminal that takes no text costs no result.
  void write() {
    std::vector<std::string> warnings = told_;
    warnings.insert(warnings.end(), warnings_.begin(), warnings_.end());
    if (!warnings.empty()) more_["warnings"] = warnings;
    if (keeper_->written() > 0)
      more_["checkpoints"] = {{"written", keeper_->written()},
                              {"seconds", keeper_->seconds()},
                              {"time", spec_.time.at(keeper_->last().time)},
                              {"bytes", keeper_->last().bytes}};
    // Before the summary, which says that the run is whole: `resume` cannot make these frames of a run that has one.
    write_reel();
    summary_text_ = write::summary_json(spec_, summary_, more_);
    const bool told = owed_.attempt([&] { write::write_text(folder_ / "summary.json", summary_text_); });
    make_films();
    // The log before the page: `resume` makes the page of a run that was killed here, and cannot make the log.
    const std::string before_page = write_log("");
    const std::string without =
        told && spec_.output.report ? write_page(folder_, spec_, owed_, pictures_come_later()) : "";
    if (log_text(without) != before_page) write_log(without);
    owed_.attempt([&] { complete() ? own_folder_->complete() : own_folder_->interrupted(how_to_go_on()); });
  }

  /// After a failure: where the run is that this one was to replace.
  void tell_what_is_kept() const {
    if (own_folder_ && own_folder_->keeps_earlier())
      note("the earlier run is whole in {}; it is replaced when another run in its place has an output\n",
           (folder_ / "earlier").string());
  }

  ExitCode report() const {
    for (const std::string& warning : warnings_) note("warning: {}\n", warning);
    put(stdout, task_.json ? summary_text_ : ending_);
    if (!complete()) {
      for (const std::string& why : owed_.missing()) note("error: {}\n", why);
      return tell_how_to_go_on();
    }
    bool failed = false;
    for (const CheckResult& result : summary_.checks) {
      if (result.passed) continue;
      failed = true;
      note("check failed: {}\n", result.text);
    }
    for (const std::string& why : owed_.missing()) note("error: {}\n", why);
    if (!looked_back_) return stop_code();
    return failed ? ExitCode::check : owed_.code();
  }

 private:
  void prepare_to_write(Simulation& simulation) {
    prepare_folder(simulation);
    note("{}", task_.told);
    const bool core_is_free = ranks_.size() == 1 && base::resolve_threads(task_.threads) <
                                                        static_cast<int>(std::thread::hardware_concurrency());
    add_observers(simulation, spec_, folder_, core_is_free, of_observers_);
    observe_for_page(simulation);
    const auto& times = spec_.output.times;
    if (looks_back(spec_) && !times.empty()) {
      // One rank of several is not to need memory for all particles, however many there are.
      const auto may_gather = [this, &simulation] {
        return ranks_.size() == 1 || static_cast<double>(simulation.particle_count()) <= spec_.output.piece_particles;
      };
      simulation.observe(keep_last_output(spec_, last_, task_.threads, may_gather));
    }
    simulation.observe(own_folder_->watch());
    if (!input::data_files(spec_).empty()) past();  // a signal is not to wait for its hash
  }

  /// What the page plays. Particles are not brought together for it alone.
  void observe_for_page(Simulation& simulation) {
    if (!spec_.output.report || !spec_.output.page.plays) return;
    reel_ = std::make_shared<report::Reel>(report::most_reel_bytes(spec_.output.page));
    const bool has_particles = ranks_.size() == 1 || base::has_one(spec_.output.files, &OutputFile::needs_velocity);
    simulation.observe(report::reel_series(reel_, spec_, has_particles));
  }

  void write_reel() {
    if (reel_ && !reel_->frames().empty())
      owed_.attempt([&] { write::write_text(folder_ / report::reel_file, reel_->text()); });
  }

  void keep_checkpoints() {
    const double most = std::min(static_cast<double>(write::usual_checkpoint_piece), spec_.output.piece_particles);
    keeper_.emplace(
        folder_, [this] { return past(); }, spec_.output.checkpoint, task_.goes_on,
        write::CheckpointWriter::Options{.threads = task_.threads,
                                         .in_haste = [this] { return in_haste(); },
                                         .piece_particles = static_cast<std::size_t>(std::max(1.0, most))},
        task_.from ? std::move(task_.from->trail) : write::CheckpointTrail(), ranks_);
    keeper_->force();  // a checkpoint that was written in haste may be all that there is
  }

  const std::string& past() {
    if (task_.past.empty()) task_.past = past_of(spec_);
    return task_.past;
  }

  /// Ranks stop together, where one of them is asked to.
  bool is_to_stop() {
    std::int64_t code = stop_->made() ? static_cast<std::int64_t>(stop_->code()) : 0;
    ranks_.max(std::span(&code, 1));
    if (code != 0) stop_code_ = static_cast<ExitCode>(code);
    return code != 0;
  }

  ExitCode stop_code() const { return stop_->by_signal() ? stop_->code() : stop_code_; }

  /// Of the page: after a signal it has those that are soon drawn.
  bool pictures_come_later() const {
    constexpr std::size_t soon_drawn = 250'000;  // points of the grid
    constexpr double soon = 0.7;                 // seconds; they take as long on a busy machine
    return in_haste() && (evaluation_lattice(spec_).size() > soon_drawn || stop_->seconds_since_signal() > soon);
  }

  /// A checkpoint, and with it the numbers so far: a run that is killed has a page.
  void keep(const Simulation& simulation, double time, std::size_t steps) {
    RunSummary so_far;
    std::string state;
    std::int64_t wanted = 0;
    ranks_.agree_on([&] {
      if (!first_) return;
      so_far = simulation.summary();
      wanted = keeper_->is_wanted(time, steps, so_far.frames.size());
      if (wanted) state = simulation.state();
    });
    ranks_.max(std::span(&wanted, 1));
    if (!wanted) return;
    keeper_->write(time, steps, so_far.frames.size(), simulation.particles(), state);
    ranks_.agree_on([&] {
      if (first_) write_summary_so_far(so_far);
    });
  }

  /// It has all outputs. Where they are many it is not written anew with each of them: the bytes written would grow with
  /// their square.
  void write_summary_so_far(const RunSummary& so_far) {
    constexpr std::size_t few = 64;
    const std::size_t outputs = so_far.frames.size(), told = outputs_in_summary_;
    if (told >= few && outputs < told + told / 8) return;
    write::write_text(folder_ / "summary.json", write::summary_json(spec_, so_far, {}));
    outputs_in_summary_ = outputs;
  }

  /// A signal's sender does not wait for the disk.
  bool in_haste() const { return stop_->by_signal() || stop_code_ != ExitCode::stopped; }

  /// Of a complete run: where they come from, and whether the target is met.
  void judge_errors() {
    if (last_.kept.any || last_.seen || spec_.output.times.empty())
      look_back_unless_stopped();
    else if (last_.too_many)
      warnings_.push_back(fmt::format(
          "no error budget and no accuracy table: they need all particles of the last output on one rank, and "
          "several ranks bring at most output.piece_particles = {:.0f} together. A run on one rank has both.",
          spec_.output.piece_particles));
    else if (looks_back(spec_))
      warnings_.push_back(
          "no error budget and no accuracy table: an earlier part of this run wrote the last output when it was not "
          "yet "
          "the last one, or did not want them, and they need it");
    if (const auto target = task_.asked.accuracy.target; target && !summary_.frames.empty()) {
      const auto& error = summary_.frames.back().second.error;
      const bool known = error && std::isfinite(error->linf);
      more_["accuracy"] = {{"target", *target},
                           {"achieved", known ? nlohmann::ordered_json(error->linf) : nlohmann::ordered_json()},
                           {"met", known && error->linf <= *target}};
      if (const std::string& why = summary_.frames.back().second.no_norms; !why.empty())
        more_["accuracy"]["not_known"] = why;
    }
  }

  void look_back_unless_stopped() {
    const base::AbandonWanted wanted = [this] { return stop_->by_signal(); };
    try {
      const base::Abandonable while_it_lasts(&wanted);
      if (!last_.seen) {
        const base::Stopwatch watch;
        last_.seen = look_back(spec_, summary_.seconds, last_.kept, summary_.stages, task_.threads);
        summary_.seconds += watch.seconds();
      }
      budget_ = last_.seen->measured;
      more_.update(last_.seen->more);
      warnings_.insert(warnings_.end(), last_.seen->warnings.begin(), last_.seen->warnings.end());
    } catch (const base::Abandoned&) {
      looked_back_ = false;
      warnings_.push_back(
          fmt::format("no error budget and no accuracy table: the program was stopped ({}) before they were ready. All "
                      "other results are there.",
                      reason_to_stop(stop_code())));
    }
  }

  void prepare_folder(const Simulation& simulation) {
    const bool goes_on = task_.goes_on;
    const std::string provenance = goes_on && !task_.changed ? "" : provenance_of(task_);
    own_folder_.emplace(
        folder_, spec_,
        write::RunFolderOptions{
            .force = task_.force,
            .go_on = goes_on,
            .bytes = disk_of(spec_, simulation, task_.threads),
            .particle_pieces =
                accuracy::pieces_of_particles(spec_, simulation.particle_count()).value_or(write::most_pieces),
            .films = film_names(spec_),
            .picture_styles = render::style_names()});
    if (provenance.empty()) return;
    // First, because it has the name of the case: a run that has a run.toml can be resumed, and pictures show the name.
    write::write_text(folder_ / "provenance.json", provenance);
    write::write_run_inputs(folder_, spec_, case_text(spec_, folder_));
  }

  /// Of a complete run. A signal ends it, and the frames stay.
  void make_films() {
    if (!complete() || !spec_.output.animation) return;
    const base::AbandonWanted wanted = [this] { return stop_->by_signal(); };
    const base::Abandonable while_it_lasts(&wanted);
    films_ = cli::make_films(folder_, spec_, task_.threads, owed_);
  }

  /// `without`: lines about the page.
  std::string log_text(const std::string& without) {
    ending_ = (complete() ? "" : stopped_text()) +
              ending_text(spec_, summary_, budget_, task_.asked.accuracy.target, folder_) + films_ + without +
              state_text() + shares_text(shares_, ranks_.hosts());
    std::string log;
    for (const std::string& warning : told_) log += "warning: " + warning + "\n";
    for (const std::string& warning : warnings_) log += "warning: " + warning + "\n";
    for (const std::string& why : owed_.missing()) log += "error: " + why + "\n";
    return base::printable_lines(log + ending_);
  }

  std::string write_log(const std::string& without) {
    std::string text = log_text(without);
    owed_.attempt([&] { write::write_text(folder_ / "log.txt", text); });
    return text;
  }

  /// After an error of the disk: a checkpoint where there is room for one.
  void keep_what_there_is(const Simulation& simulation) {
    try {
      const RunSummary so_far = simulation.summary();
      keep(simulation, so_far.elapsed, so_far.steps);
    } catch (const FileError&) {  // the one before stands
    }
  }

  /// A run that goes on has a checkpoint of an earlier process at least.
  bool has_checkpoint() const { return task_.goes_on || (keeper_ && keeper_->written() > 0); }

  std::string how_to_go_on() const {
    const std::string resume = fmt::format("resume with: gaussdrift resume {}", base::shell_word(folder_.string()));
    if (has_checkpoint()) return resume;
    const bool wants_none = spec_.output.checkpoint && *spec_.output.checkpoint == 0;
    return fmt::format(
        "{}. It begins again from the start, because there is no checkpoint{}. What is written is kept until it has "
        "its "
        "first output",
        resume, wants_none ? " (output.checkpoint = 0)" : "");
  }

  std::string stopped_text() const {
    return fmt::format("stopped at t = {:.6g} of {:.6g} ({}). {}\n", summary_.time, spec_.time.at(spec_.time.end),
                       reason_to_stop(stop_code()), how_to_go_on());
  }

  std::string state_text() const {
    if (keeper_->written() == 0 || !complete()) return "";
    return fmt::format("state  {} took {:.2g} s; the last has {} ({}/{}): gaussdrift resume --until T goes on\n",
                       base::counted(keeper_->written(), "checkpoint"), keeper_->seconds(),
                       base::size_text(keeper_->last().bytes), base::printable(folder_.string()),
                       write::checkpoints_folder);
  }

  RunTask& task_;
  const Case& spec_;
  const fs::path folder_;
  base::Communicator& ranks_;
  const bool first_;
  ExitCode stop_code_ = ExitCode::stopped;  // of the rank that was asked
  std::optional<StopRequest> stop_;
  std::atomic<bool> moved_on_{false};   // by a step or more
  std::size_t outputs_in_summary_ = 0;  // as it was written last
  std::optional<CheckpointKeeper> keeper_;
  LastOutput last_;
  std::shared_ptr<report::Reel> reel_;  // null: the page does not play
  RunSummary summary_;
  std::optional<accuracy::Budget> budget_;
  bool looked_back_ = true;                                  // or did not want to
  std::vector<std::string> told_, warnings_, of_observers_;  // warnings: at the start, for the end, of observers
  double share_seconds_ = 0;                                 // processor seconds of this rank in the run
  std::vector<RankShare> shares_;                            // of all ranks, on rank 0
  // Members of summary.json beside those of the run.
  nlohmann::ordered_json more_ = nlohmann::ordered_json::object();
  std::string summary_text_, ending_, films_;
  OwedFiles owed_;
  std::optional<write::RunFolder> own_folder_;
};

}  // namespace

std::string past_of(const Case& spec) { return write::hash_of(input::text_of_past(spec), data_of(spec, {})); }

ExitCode carry_out(RunTask task, base::Communicator& ranks) {
  if (task.done) return *task.done;
  const bool first = ranks.rank() == 0;
  Run run(task, ranks);
  bool went_on = true;
  try {
    run.check_common_ground();
    went_on = run.simulate();
    run.gather_shares();
  } catch (...) {
    if (first) run.tell_what_is_kept();
    throw;
  }
  std::int64_t code = 0;
  ranks.agree_on([&] {
    if (!first) return;
    if (went_on) {
      run.explain_errors();
      run.write();
    }
    code = static_cast<std::int64_t>(went_on ? run.report() : run.tell_how_to_go_on());
  });
  run.force_checkpoint();
  ranks.sum(std::span(&code, 1));  // the others have 0
  return static_cast<ExitCode>(code);
}

}  // namespace gaussdrift::cli
