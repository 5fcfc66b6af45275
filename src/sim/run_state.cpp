#include "sim/run_state.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "base/broadcast.hpp"
#include "gaussdrift/error.hpp"
#include "particle/pieces_by_id.hpp"
#include "sim/landings.hpp"
#include "sim/run_parts.hpp"

namespace gaussdrift {

namespace {

InputError misfit(const std::string& what) { return InputError("the state is not one of this case: " + what); }

// What every step makes sure of, of particles that come from elsewhere.
bool all_finite(const Particles& particles) {
  const auto finite = [](const std::vector<double>& numbers) {
    return std::all_of(numbers.begin(), numbers.end(), [](double number) { return std::isfinite(number); });
  };
  return std::all_of(particles.position.begin(), particles.position.end(), finite) && finite(particles.alpha) &&
         std::all_of(particles.path.begin(), particles.path.end(), finite) &&
         std::all_of(particles.kept.begin(), particles.kept.end(), finite) && finite(particles.volume) &&
         std::all_of(particles.tracers.begin(), particles.tracers.end(), finite);
}

void pass(base::StateBytes& bytes, RunState& parts) {
  auto later = static_cast<unsigned char>(parts.format - 1);
  bytes(later, parts.run, parts.outputs);
  parts.format = later + 1u;
  if (parts.format > newest_format) throw std::out_of_range("its format is not known");
  bytes.end();
}

using Output = std::pair<double, FrameNumbers>;

void pass(base::StateBytes& bytes, Output& output, Counted counted) {
  bytes(output.first);
  pass(bytes, output.second, counted);
}

}  // namespace

RunState parted(std::string_view state) {
  base::StateBytes bytes(state);
  RunState parts;
  pass(bytes, parts);
  return parts;
}

std::string joined(RunState& parts) {
  base::StateBytes bytes;
  pass(bytes, parts);
  return bytes.written();
}

// A state may be a stranger's: numbers that count steps, and those that index, are looked at before they are used.
void Simulation::Parts::check_leg() const {
  constexpr double most_steps = 1e15;  // so that they can be counted
  const bool countable = carrier_.is_adaptive() || (leg_.to - leg_.from) / case_.time.step < most_steps;
  if (!(leg_.from >= 0 && leg_.from <= leg_.now && leg_.now <= leg_.to && std::isfinite(leg_.to) && countable))
    throw std::out_of_range("its times are wrong");
}

void Simulation::Parts::check_frames() const {
  double last = 0;
  for (const auto& [time, numbers] : summary_.frames) {
    if (!(time >= last && time <= leg_.now)) throw std::out_of_range("the times of its outputs are wrong");
    last = time;
  }
  if (index_ < 0 || static_cast<std::size_t>(index_) != summary_.frames.size())
    throw std::out_of_range("its outputs are not as many as it counts");
}

void Simulation::Parts::pass_outputs(base::StateBytes& bytes) {
  std::uint64_t count = summary_.frames.size();
  bytes(count);
  if (bytes.reading()) summary_.frames.clear();
  for (std::uint64_t i = 0; i < count; ++i) {
    if (bytes.reading()) summary_.frames.emplace_back();
    pass(bytes, summary_.frames[i], counted());
  }
}

std::vector<std::string> Simulation::Parts::outputs() {
  std::vector<std::string> all;
  for (Output& output : summary_.frames) {
    base::StateBytes bytes;
    pass(bytes, output, counted());
    all.push_back(bytes.written());
  }
  return all;
}

void Simulation::Parts::take_outputs(const std::vector<std::string>& all) {
  summary_.frames.clear();
  for (const std::string& output : all) {
    base::StateBytes bytes(output);
    pass(bytes, summary_.frames.emplace_back(), counted());
    bytes.end();
  }
}

// Of the outputs so far, behind that of the begin.
std::vector<double> Simulation::Parts::landed_on() const {
  std::vector<double> times{0};
  for (const auto& [time, numbers] : summary_.frames)
    if (time > 0) times.push_back(time);
  return times;
}

// What the run has come to, beside the particles and, mostly, the numbers of the outputs.
void Simulation::Parts::pass_state(base::StateBytes& bytes, std::uint64_t format, ObserverStates& seen) {
  bytes(leg_, steps_before_, index_);
  if (bytes.reading()) check_leg();
  carrier_.pass_state(bytes, particles_, format > 2 ? landed_on() : std::vector<double>());
  if (releases_.possible()) releases_.pass_state(bytes);
  if (carrier_.memory().wanted()) carrier_.memory().pass_gone(bytes);
  if (tracks_.wanted()) tracks_.pass_state(bytes);
  if (!moments_.empty()) bytes(moments_shown_, last_moment_);
  bytes(summary_.transform_choice, summary_.transform_achievable);
  if (format == 1)
    pass_outputs(bytes);
  else
    bytes(summary_.derivatives_achievable, summary_.derivatives_error);
  ReferenceReport& traced = summary_.reference;
  if (bytes.reading()) check_frames();
  bytes(traced.untraced, traced.first_untraced, traced.trouble, traced.rates, traced.exhausted);
  auto stages = summary_.stages.stages();
  double seconds = seconds_before_ + watch_.seconds();
  bytes(stages, seconds, seen);
  bytes.end();
  if (!bytes.reading()) return;
  summary_.stages = {};
  for (const auto& [stage, spent] : stages) summary_.stages.add(stage, spent);
  seconds_before_ = seconds;
}

// Observers as they were after the outputs so far.
void Simulation::Parts::take_up_outputs(const ObserverStates& seen) {
  const auto frames = frames_as_told();
  for (const auto& observer : observers) {
    const auto same =
        std::find_if(seen.begin(), seen.end(), [&](const auto& other) { return other.first == observer->name(); });
    observer->restore(frames, same == seen.end() ? std::string() : same->second);
  }
}

std::string Simulation::Parts::state() {
  ObserverStates seen;
  for (const auto& observer : observers) seen.emplace_back(observer->name(), observer->state());
  base::StateBytes bytes;
  RunState parts;
  pass_state(bytes, parts.format, seen);
  parts.run = bytes.written();
  parts.outputs = outputs();
  return joined(parts);
}

// From where the particles are. The end of the leg under way is kept, because its steps lead there; only an earlier
// output may shorten it.
void Simulation::Parts::plan_landings() {
  std::vector<double> later;
  for (const double landing : landings(case_))
    if (landing > leg_.now) later.push_back(landing);
  const bool arrived = leg_.now >= leg_.to;
  if (leg_.now > case_.time.end || (!arrived && later.empty()))
    throw InputError(fmt::format("time.end = {:g} lies before t = {:g}, where the run is",
                                 case_.time.at(case_.time.end), case_.time.at(leg_.now)));
  if (!arrived && later.front() < leg_.to) {
    if (carrier_.acts_between_steps())
      throw InputError(fmt::format(
          "the next output has to stay at t = {:g}, because an effect of this case has begun what ends there. "
          "Outputs after it may change.",
          case_.time.at(leg_.to)));
    leg_.to = later.front();
  }
  // An output at the end of the leg is shown by run(), perhaps again.
  while (arrived && !summary_.frames.empty() && summary_.frames.back().first >= leg_.to) {
    summary_.frames.pop_back();
    --index_;
  }
  if (arrived && moments_shown_ > 0 && last_moment_ >= leg_.to) --moments_shown_;  // it is shown again
  landings_.assign(1, leg_.to);
  for (const double landing : later)
    if (landing > leg_.to) landings_.push_back(landing);
  landed_ = 0;
}

std::size_t Simulation::Parts::steps_to_end() const {
  if (carrier_.is_adaptive()) return 0;
  std::size_t steps = steps_before_;
  double from = leg_.from;
  for (std::size_t i = landed_; i < landings_.size(); ++i) {
    steps += time::Interval(from, landings_[i], case_.time.step).steps();
    from = landings_[i];
  }
  return steps;
}

// Every rank brings some of them, which stay there until they are placed.
void Simulation::Parts::take_particles(Particles particles) {
  const std::size_t integrals = particles_.path.size(), kept = particles_.kept.size();
  ranks_.agree_on([&] {
    if (particles.size() == 0) return;
    if (particles.dimension != particles_.dimension || particles.path.size() != integrals ||
        particles.kept.size() != kept || particles.tracers.size() != case_.tracers.size() ||
        (particles_.size() > 0 && particles.volume.empty() != particles_.volume.empty()))
      throw misfit("it has other particles");
    if (!all_finite(particles)) throw misfit("a number of its particles is not finite");
  });
  const bool none = particles_of_all(particles, ranks_) == 0;
  ranks_.agree_on([&] {
    if (none && !carrier_.departures().possible() && !releases_.possible()) throw misfit("it has no particles");
  });
  if (particles.size() > 0) {
    particles_ = std::move(particles);
  } else {
    particles_ = {};
    particles_.dimension = scene_.seeding.dimension;
    particles_.path.resize(integrals);
    particles_.kept.resize(kept);
    particles_.tracers.resize(case_.tracers.size());
  }
  particles_.spread = place_.max(particles_.spread);
}

void Simulation::Parts::restore(Particles particles, const std::string& bytes) {
  if (stage_ != Stage::made && stage_ != Stage::prepared)
    throw std::logic_error("Simulation::restore(): this run has begun");
  prepare();
  begin();
  take_particles(std::move(particles));
  const std::string of_all = base::broadcast_text(ranks_, bytes);
  ObserverStates seen;
  ranks_.agree_on([&] {
    try {
      const RunState parts = parted(of_all);
      if (parts.format > 1) take_outputs(parts.outputs);
      base::StateBytes state(parts.run);
      pass_state(state, parts.format, seen);
      plan_landings();
      if (!carrier_.has_steps_until(leg_.now)) throw misfit("it has other steps");
    } catch (const std::out_of_range& error) {
      throw misfit(error.what());
    }
  });
  placed_at_.reset();
  place(leg_.now);
  try {
    const base::AbandonableTogether while_it_lasts(ranks_, abandon_wanted());
    take_up(seen);
  } catch (const base::Abandoned&) {
    throw Abandoned();
  }
  steps_total_ = steps_to_end();
}

// Observers and reference as they were after the outputs so far.
void Simulation::Parts::take_up(const ObserverStates& seen) {
  on_first([&] {
    try {
      take_up_outputs(seen);
    } catch (const std::out_of_range& error) {  // in an observer
      throw misfit(error.what());
    }
  });
  std::vector<double> times;
  for (const auto& [time, numbers] : summary_.frames) times.push_back(time);
  if (compares_everywhere() && !in_pieces()) ranks_.agree_on([&] { reference_->pass(times); });
}

}  // namespace gaussdrift
