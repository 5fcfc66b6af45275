#include "cli/look_back.hpp"

#include <fmt/format.h>

#include <new>
#include <stdexcept>
#include <utility>

#include "accuracy/accuracy_table.hpp"
#include "accuracy/next_target.hpp"
#include "base/json_file.hpp"
#include "base/state_bytes.hpp"
#include "base/stopwatch.hpp"
#include "sim/grid_pieces.hpp"

namespace gaussdrift::cli {

namespace {

bool budgeted(const Case& spec) {
  return spec.accuracy.budget != AccuracySpec::Budget::none &&
         (spec.reference.kind != ReferenceSpec::Kind::none || accuracy::moves_by_chance(spec));
}

void pass(base::StateBytes& bytes, LookBack& seen) {
  bool there = seen.measured.has_value();
  bytes(there);
  if (bytes.reading()) seen.measured = there ? std::optional(accuracy::Budget()) : std::nullopt;
  if (there) accuracy::pass(bytes, *seen.measured);
  std::string more = seen.more.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  bytes(more, seen.warnings);
  if (bytes.reading()) seen.more = base::json_in(more);
  // Written by runs with samples alone, so that the bytes of all others stay what they were.
  const bool noisy = there && seen.measured->only_some;
  if (there && (bytes.reading() ? bytes.has_more() : seen.measured->fit > 0 || noisy)) bytes(seen.measured->fit);
  if (there && (bytes.reading() ? bytes.has_more() : noisy)) accuracy::pass_noise(bytes, *seen.measured);
}

class KeepLastOutput : public accuracy::LastFrame {
 public:
  KeepLastOutput(const Case& spec, LastOutput& last, int threads, std::function<bool()> may_gather)
      : LastFrame(last.kept, spec.output.times.back()),
        spec_(spec),
        last_(last),
        threads_(threads),
        may_gather_(std::move(may_gather)) {}

  bool needs_particles(double time) const override { return LastFrame::needs_particles(time) && may_gather_(); }

  void frame(const Frame& frame) override {
    last_.too_many = LastFrame::needs_particles(frame.elapsed) && !may_gather_();
    if (last_.too_many) return;
    LastFrame::frame(frame);
    if (!last_.kept.any || last_.kept.time >= spec_.time.end) return;
    StageTimes within_this_stage;
    last_.seen = look_back(spec_, frame.numbers.seconds, last_.kept, within_this_stage, threads_);
    last_.kept = {};  // its particles need not stay in memory
  }

  std::string state() const override {
    if (!last_.seen) return {};
    double time = spec_.output.times.back();
    base::StateBytes bytes;
    bytes(time);
    pass(bytes, *last_.seen);
    return bytes.written();
  }

  /// Of a run whose last output is another by now it is of no use.
  void restore(const std::vector<std::pair<double, FrameNumbers>>& frames, const std::string& state) override {
    if (state.empty()) return;
    base::StateBytes bytes(state);
    double time = 0;
    LookBack seen;
    bytes(time);
    pass(bytes, seen);
    bytes.end();
    const double last = spec_.output.times.back();
    if (time == last && !frames.empty() && frames.back().first == spec_.time.at(last)) last_.seen = std::move(seen);
  }

 private:
  const Case& spec_;
  LastOutput& last_;
  int threads_;
  std::function<bool()> may_gather_;
};

}  // namespace

bool looks_back(const Case& spec) {
  // It needs the density as a whole.
  if (pieces_of_grid(spec).count() > 1) return false;
  return (budgeted(spec) && (accuracy::budget_not_covered(spec).empty() || accuracy::moves_by_chance(spec))) ||
         spec.output.report;
}

LookBack look_back(const Case& spec, double run_seconds, const accuracy::LastFrame::Kept& last, StageTimes& stages,
                   int threads) {
  LookBack seen;
  const base::Stopwatch all;
  const auto stage = [&](const char* name, const auto& work) {
    const base::Stopwatch watch;
    try {
      work();
    } catch (const std::bad_alloc&) {
      seen.warnings.push_back(fmt::format("no {}: out of memory", name));
    } catch (const std::exception& error) {
      seen.warnings.push_back(fmt::format("no {}: {}", name, error.what()));
    }
    stages.add(name, watch.seconds());
  };
  std::optional<accuracy::Budget> predicted;
  if (budgeted(spec)) {
    const auto effort = spec.accuracy.budget == AccuracySpec::Budget::measured ? accuracy::Effort::whatever
                                                                               : accuracy::Effort::share_of_run;
    stage("error budget",
          [&] { seen.measured = accuracy::measure_budget(spec, make_scene(spec, threads), last, effort, threads); });
    stage("predicted error budget",
          [&] { predicted = accuracy::predict_budget(spec, make_scene(spec, threads), effort, threads); });
  }
  if (seen.measured && predicted)
    seen.more["budget"] = {{"norm", "largest error at the last output, relative to the largest exact density there"},
                           {"predicted", accuracy::to_json(*predicted)},
                           {"measured", accuracy::to_json(*seen.measured)},
                           {"advice", seen.measured->advice}};
  if (spec.output.report && last.numbers.error && seen.more.contains("budget"))
    stage("next accuracy", [&] {
      double seconds = stages.of("transport") + stages.of("density");
      for (const EffectSpec& effect : spec.effects.list) seconds += stages.of("effect " + effect.name);
      if (seconds == 0) return;  // an earlier process has taken them
      const auto next = accuracy::next_target(spec, last.numbers.error->linf, last.particles.size(), seconds, threads);
      if (!next) return;
      seen.more["budget"]["more_accurate"] = {
          {"target", next->target}, {"settings", next->settings}, {"seconds_more", next->seconds_more}};
    });
  if (spec.output.report)
    stage("accuracy table",
          [&] { seen.more.update(accuracy::accuracy_table(spec, run_seconds + all.seconds(), last, threads)); });
  return seen;
}

std::unique_ptr<Observer> keep_last_output(const Case& spec, LastOutput& last, int threads,
                                           std::function<bool()> may_gather) {
  return std::make_unique<KeepLastOutput>(spec, last, threads, std::move(may_gather));
}

}  // namespace gaussdrift::cli
