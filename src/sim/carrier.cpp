#include "sim/carrier.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>

#include "base/longest_side.hpp"
#include "base/number.hpp"
#include "base/parallel.hpp"
#include "base/stopwatch.hpp"
#include "gaussdrift/error.hpp"
#include "sim/borders/edges.hpp"
#include "sim/scene.hpp"

namespace gaussdrift {

namespace {

std::vector<Effect*> integrating(const Effects& effects) {
  std::vector<Effect*> some;
  for (const auto& effect : effects)
    if (effect->path_integral()) some.push_back(effect.get());
  return some;
}

std::vector<const PathIntegral*> integrals_of(const std::vector<Effect*>& effects) {
  std::vector<const PathIntegral*> integrals;
  for (const Effect* effect : effects) integrals.push_back(effect->path_integral());
  return integrals;
}

/// A drift where the clock goes backwards.
class ReversedDrift : public Drift {
 public:
  explicit ReversedDrift(const Drift& drift) : drift_(drift) {}
  void add(double t, const Particles& particles, const PointsView& x, const VectorsView& u) const override {
    negate(u);
    drift_.add(t, particles, x, u);
    negate(u);
  }

 private:
  static void negate(const VectorsView& u) {
    for (int k = 0; k < u.dimension; ++k)
      for (std::size_t j = 0; j < u.count; ++j) u.axis[k][j] = -u.axis[k][j];
  }
  const Drift& drift_;
};

std::vector<const Drift*> drifts_of(const Effects& effects, bool backwards,
                                    std::vector<std::unique_ptr<Drift>>& reversed) {
  std::vector<const Drift*> drifts;
  for (const auto& effect : effects) {
    if (!effect->drift()) continue;
    if (backwards) reversed.push_back(std::make_unique<ReversedDrift>(*effect->drift()));
    drifts.push_back(backwards ? reversed.back().get() : effect->drift());
  }
  return drifts;
}

/// Adds what weights have changed by, as it is or (sign = -1) what they have lost.
void count_change(const std::vector<double>& before, const std::vector<double>& after, double sign,
                  base::ExactSum& sum) {
  for (std::size_t j = 0; j < before.size(); ++j)
    if (before[j] != after[j]) sum.add(-sign * before[j]), sum.add(sign * after[j]);
}

std::string stage_of(const Effect& effect) { return "effect " + effect.name(); }

}  // namespace

Carrier::Carrier(const Case& spec, const Scene& scene, int threads) : Carrier(spec, scene, threads, alone_, {}) {}

Carrier::Carrier(const Case& spec, const Scene& scene, int threads, base::Communicator& ranks, const RankAt& rank_at)
    : ranks_(ranks),
      effects_(make_effects(
          spec, scene, [this](Particles& particles) { follow(particles); }, ranks, rank_at, threads)),
      integrating_(integrating(effects_)),
      drifts_(drifts_of(effects_, spec.time.backwards, reversed_)),
      between_steps_(std::any_of(effects_.begin(), effects_.end(),
                                 [](const auto& effect) { return effect->acts_between_steps(); })),
      folding_(folding_of(spec.domain)),
      departures_(ways_out(spec), spec.tracers.size()),
      memory_(spec),
      counts_decay_(!spec.sources.empty() && !integrating_.empty()),
      reacted_(integrating_.empty() ? 0 : spec.tracers.size()),
      coast_(spec.domain.coast != AtCoast::refuse ? scene.coast.get() : nullptr),
      tableau_(time::find_tableau(spec.time.method)),
      case_(spec),
      scene_(scene),
      stepper_(*scene.velocity, tableau_, threads, integrals_of(integrating_), drifts_, &ranks),
      threads_(base::resolve_threads(threads)) {
  if (memory_.wanted())
    departures_.on_leaving([this](const Particles& particles, std::size_t j) { memory_.leave(particles, j); });
  if (!time::is_adaptive(tableau_)) return;
  AdaptiveStepper::Options options{spec.time.tolerance, 0, spec.time.step, threads};
  options.length = longest_side(spec.domain.dimension, spec.domain.min, spec.domain.max);
  adaptive_.emplace(*scene.velocity, tableau_, integrals_of(integrating_), drifts_, options, ranks);
}

template <class Hook>
void Carrier::call(const Effect& effect, const Hook& hook) const {
  if (effect.talks_to_ranks())
    hook();
  else
    ranks_.agree_on(hook);
}

void Carrier::begin(Particles& particles, const Particles& sample) {
  for (const auto& effect : effects_)
    call(*effect, [&] {
      effect->look_at(sample);
      effect->begin(particles, 0);
    });
  ranks_.agree_on([&] {
    particles.path.assign(rows_of(integrals_of(integrating_)), std::vector<double>(particles.size(), 0.0));
    memory_.begin(particles);
    if (is_adaptive() || case_.time.end <= 0) return;
    flow_ = sample_flow_rates(*scene_.velocity, sample, case_.time.end, difference_length(scene_));
    refuse_unstable_step();
    warn_of_jumps(sample);
  });
}

void Carrier::placed(const Particles& particles) {
  for (const auto& effect : effects_) call(*effect, [&] { effect->placed(particles); });
}

double Carrier::longest_step(const time::Tableau& tableau, double step) const {
  double longest = longest_stable_step(flow_, tableau, case_.time.end, step).step;
  for (const auto& effect : effects_) longest = std::min(longest, effect->stable_step());
  return longest;
}

void Carrier::refuse_unstable_step() const {
  // The longest step taken: one longer than the run is cut.
  const double step = std::min(case_.time.step, case_.time.end), allowed = longest_step(tableau_, step);
  const auto too_long = [&](double longest) { return longest < step * (1 - 1e-9); };
  if (!too_long(allowed)) return;
  const double longest = base::rounded_down(allowed, 3);
  const StableStep stable = longest_stable_step(flow_, tableau_, case_.time.end, step);
  if (!too_long(stable.step)) {
    const auto refusing = std::min_element(effects_.begin(), effects_.end(), [](const auto& a, const auto& b) {
      return a->stable_step() < b->stable_step();
    });
    throw InputError(fmt::format("time.step = {:g} is not stable with [effects.{}]. Use time.step <= {:g}.",
                                 case_.time.step, (*refusing)->name(), longest));
  }
  // The method of fewest stages that takes this step.
  const time::Tableau* other = nullptr;
  for (const time::Tableau& tableau : time::tableaux())
    if (!time::is_adaptive(tableau) && (!other || tableau.stages < other->stages) &&
        !too_long(longest_step(tableau, step)))
      other = &tableau;
  const FlowRate& rate = *stable.limited_by;
  std::string place;
  for (int k = 0; k < case_.domain.dimension; ++k) place += fmt::format("{}{:.4g}", k ? ", " : "", rate.place[k]);
  throw InputError(fmt::format(
      "With time.step = {:g} the method \"{}\" amplifies {} by more than {:g} % over this run: the flow {} at the rate "
      "{:.4g} at ({}), t = {:.4g}. Use time.step <= {:g}{}.",
      case_.time.step, tableau_.name, rate.turns() ? "a pure rotation" : "what should only decay", 100 * growth_allowed,
      rate.turns() ? "turns" : "contracts", rate.turns() ? std::abs(rate.value.imag()) : -rate.value.real(), place,
      case_.time.at(rate.time), longest, other ? fmt::format(", or time.method = \"{}\"", other->name) : ""));
}

// Particles that cross a jump in one step take the velocity of one side for a part of the step that belongs to the
// other.
void Carrier::warn_of_jumps(const Particles& particles) {
  warnings_.clear();
  if (scene_.velocity->is_smooth()) return;
  std::vector<Jump> jumps = flow_.jumps;
  // Between neighbours of the lattice as well: the rates see only what is next to a particle.
  const double half = 0.51 * scene_.seeding.spacing;  // a little more: a jump in the middle is on one side
  const FlowRates between = sample_flow_rates(*scene_.velocity, particles, case_.time.end, half);
  jumps.insert(jumps.end(), between.jumps.begin(), between.jumps.end());
  const auto largest =
      std::max_element(jumps.begin(), jumps.end(), [](const Jump& a, const Jump& b) { return a.height < b.height; });
  if (largest == jumps.end()) return;
  const double misplaced = largest->height * std::min(case_.time.step, case_.time.end);
  if (!(misplaced > difference_length(scene_))) return;
  std::string place;
  for (int k = 0; k < case_.domain.dimension; ++k) place += fmt::format("{}{:.4g}", k ? ", " : "", largest->place[k]);
  warnings_.push_back(
      fmt::format("the velocity jumps by {:.3g} at ({}), t = {:.4g}: a particle that crosses the jump in one step is "
                  "misplaced by up "
                  "to {:.2g}, the jump times time.step{}",
                  largest->height, place, case_.time.at(largest->time), misplaced,
                  case_.reference.kind == ReferenceSpec::Kind::characteristics
                      ? ". The exact density does not contain what gathers or thins out at the jump"
                      : ""));
}

bool Carrier::carry(Particles& particles, Leg& leg, std::size_t steps_before, StageTimes& stages,
                    const std::function<bool(const Leg& leg)>& go_on) {
  const bool arrived = carry_on(particles, leg, steps_before, stages, go_on);
  if (arrived) land(particles, leg.to, stages);
  if (departures_.possible()) departures_.bring_together(ranks_);
  if (departures_.possible() && memory_.wanted()) memory_.bring_together(ranks_);
  if (counts_decay_) bring_together(decayed_);
  for (Changed& tracer : reacted_) bring_together(tracer);
  return arrived;
}

void Carrier::bring_together(Changed& changed) {
  base::sum_over_ranks(ranks_, std::span(&changed.own, 1));
  changed.together.add(changed.own);
  changed.own = {};
}

std::optional<double> Carrier::reacted(std::size_t tracer) const {
  return reacted_.empty() ? std::nullopt : std::optional(reacted_[tracer].together.value());
}

std::optional<double> Carrier::decayed() const {
  return counts_decay_ ? std::optional(decayed_.together.value()) : std::nullopt;
}

bool Carrier::carry_on(Particles& particles, Leg& leg, std::size_t steps_before, StageTimes& stages,
                       const std::function<bool(const Leg& leg)>& go_on) {
  return adaptive_ ? adapt(particles, leg, steps_before, stages, go_on)
                   : step(particles, leg, steps_before, stages, go_on);
}

std::size_t Carrier::carry(Particles& particles, double from, double to, std::size_t steps_before, StageTimes& stages) {
  Leg leg{from, to, 0, from};
  carry(particles, leg, steps_before, stages, [](const Leg&) { return true; });
  return leg.steps;
}

// Steps of transport alone set positions at their very end, but one rank may be there before another abandons them. Steps
// that are chosen set positions once all ranks have agreed.
bool Carrier::attempt(Particles& particles, const std::function<void()>& steps) {
  if (!abandon_wanted_) return steps(), true;
  const bool changed = between_steps_ || looks_at_steps();
  const bool only_moved = !changed && !adaptive_ && ranks_.size() > 1;
  base::StateBytes effects;
  pass_state(effects, particles);
  if (changed) before_ = particles;
  if (only_moved) before_.position = particles.position, before_.path = particles.path;
  bool taken = true;
  try {
    const base::AbandonableTogether while_they_last(ranks_, abandon_wanted_);
    steps();
  } catch (const base::Abandoned&) {
    taken = false;
    if (changed) particles = before_;
    if (only_moved) particles.position.swap(before_.position), particles.path.swap(before_.path);
    base::StateBytes back(effects.written());
    pass_state(back, particles);
  }
  if (only_moved) before_ = {};
  return taken;
}

bool Carrier::adapt(Particles& particles, Leg& leg, std::size_t steps_before, StageTimes& stages,
                    const std::function<bool(const Leg& leg)>& go_on) {
  while (leg.now < leg.to) {
    double reached = leg.now;
    const bool taken = attempt(particles, [&] {
      const base::Stopwatch watch;
      if (needs_beginnings()) began_ = particles.position;
      const double before = adaptive_->drift_seconds();
      reached = adaptive_->advance(particles, leg.now, leg.to, steps_before + leg.steps);
      const double drifts = adaptive_->drift_seconds() - before;
      stages.add("transport", watch.seconds() - drifts);
      for (const auto& effect : effects_)
        if (effect->drift()) stages.add(stage_of(*effect), drifts / static_cast<double>(drifts_.size()));
      arrive(particles, leg.now, reached, stages);
      if (between_steps_) {
        settle(particles, reached, stages);
        rearrange(particles, reached, stages);
      }
    });
    if (!taken) return false;
    leg.now = reached;
    ++leg.steps;
    if (!all_go_on(go_on, leg) && leg.now < leg.to) return false;
  }
  return true;
}

// Ranks stop together.
bool Carrier::all_go_on(const std::function<bool(const Leg& leg)>& go_on, const Leg& leg) const {
  std::int64_t stops = !go_on(leg);
  ranks_.max(std::span(&stops, 1));
  return stops == 0;
}

bool Carrier::step(Particles& particles, Leg& leg, std::size_t steps_before, StageTimes& stages,
                   const std::function<bool(const Leg& leg)>& go_on) {
  const time::Interval interval(leg.from, leg.to, case_.time.step);
  // Batches are short enough for a lively progress line and long enough that threads start rarely.
  constexpr std::size_t stages_a_batch = 4'000'000;
  auto most = static_cast<std::int64_t>(particles.size());  // of any rank: all take as many steps at a time
  ranks_.max(std::span(&most, 1));
  const std::size_t stages_a_step =
      std::max<std::size_t>(1, static_cast<std::size_t>(most) * static_cast<std::size_t>(tableau_.stages));
  const bool quick = drifts_.empty() && !between_steps_ && !looks_at_steps();
  const std::size_t batch = quick ? std::clamp<std::size_t>(stages_a_batch / stages_a_step, 1, 1000) : 1;
  while (leg.steps < interval.steps()) {
    const std::size_t first = leg.steps;
    std::size_t count = std::min(batch, interval.steps() - first);
    const double held = scene_.velocity->held_until(interval.start(first));
    if (pause_every_ > 0) count = std::min(count, pause_every_ - (steps_before + first) % pause_every_);
    while (count > 1 && interval.start(first + count) > held) --count;
    if (!attempt(particles, [&] { advance(particles, interval, first, count, steps_before, stages); })) return false;
    leg.steps += count;
    leg.now = interval.start(leg.steps);
    if (!all_go_on(go_on, leg) && leg.steps < interval.steps()) return false;
  }
  return true;
}

void Carrier::advance(Particles& particles, const time::Interval& interval, std::size_t first, std::size_t count,
                      std::size_t steps_before, StageTimes& stages) {
  if (!between_steps_ && !looks_at_steps()) return take_steps(particles, interval, first, count, steps_before, stages);
  // Strang's splitting: half a step of exchange on either side of each step; two halves that meet are one.
  for (std::size_t i = first; i < first + count; ++i) {
    const double half = interval.length(i) / 2;
    if (i == 0) exchange(particles, interval.start(i), half, stages);
    if (needs_beginnings()) began_ = particles.position;
    const std::uint64_t part = 2 * static_cast<std::uint64_t>(steps_before + i);
    scatter(particles, {part, interval.start(i), half}, stages);
    take_steps(particles, interval, i, 1, steps_before, stages);
    scatter(particles, {part + 1, interval.start(i) + half, half}, stages);
    arrive(particles, interval.start(i), interval.start(i + 1), stages);
    if (!between_steps_) continue;
    taken_.add(interval, i);
    const double now = interval.start(i + 1);
    settle(particles, now, stages);
    rearrange(particles, now, stages);
    exchange(particles, now, half + (i + 1 < interval.steps() ? interval.length(i + 1) / 2 : 0), stages);
  }
}

void Carrier::pass_state(base::StateBytes& bytes, const Particles& particles, std::span<const double> landed_on) {
  std::uint64_t effects = effects_.size();
  bytes(effects);
  if (effects != effects_.size()) throw std::out_of_range("there are other effects");
  if (landed_on.empty())
    taken_.pass(bytes);
  else
    taken_.pass(bytes, landed_on, case_.time.step);
  if (adaptive_) adaptive_->pass_state(bytes);
  if (departures_.possible()) departures_.pass_state(bytes);
  if (departures_.possible() && memory_.wanted()) memory_.pass_state(bytes);
  if (counts_decay_) bytes(decayed_.own, decayed_.together);
  for (Changed& tracer : reacted_) bytes(tracer.own, tracer.together);
  for (const auto& effect : effects_) effect->pass_state(bytes, particles);
}

void Carrier::take_steps(Particles& particles, const time::Interval& interval, std::size_t first, std::size_t count,
                         std::size_t steps_before, StageTimes& stages) const {
  // Drifts talk to other ranks at every stage, and agree on errors there.
  agree_on(drifts_.empty() ? &ranks_ : nullptr,
           [&] { take_own_steps(particles, interval, first, count, steps_before, stages); });
}

void Carrier::take_own_steps(Particles& particles, const time::Interval& interval, std::size_t first, std::size_t count,
                             std::size_t steps_before, StageTimes& stages) const {
  const base::Stopwatch watch;
  const StepperSeconds spent = stepper_.advance(particles, interval, first, count, steps_before);
  // With drifts there is one block, on one thread.
  const double integrals = spent.integrals / (drifts_.empty() ? threads_ : 1);
  stages.add("transport", watch.seconds() - integrals - spent.drifts);
  for (const auto& effect : effects_)
    if (effect->drift()) stages.add(stage_of(*effect), spent.drifts / static_cast<double>(drifts_.size()));
  // The integrals are evaluated together; their time is shared evenly.
  for (const Effect* effect : integrating_)
    stages.add(stage_of(*effect), integrals / static_cast<double>(integrating_.size()));
}

void Carrier::settle(Particles& particles, double time, StageTimes& stages) {
  std::size_t first = 0;  // row of its path integrals
  for (Effect* effect : integrating_) {
    const std::size_t rows = effect->path_integral()->rows();
    stages.run(stage_of(*effect), [&] {
      const std::vector<double> before = counts_decay_ ? particles.alpha : std::vector<double>();
      const auto tracers_before = reacted_.empty() ? std::vector<std::vector<double>>() : particles.tracers;
      call(*effect, [&] { effect->settle(particles, particles.path[first].data(), time); });
      for (std::size_t row = first; row < first + rows; ++row)
        std::fill(particles.path[row].begin(), particles.path[row].end(), 0.0);
      count_change(before, particles.alpha, -1, decayed_.own);
      for (std::size_t k = 0; k < tracers_before.size(); ++k)
        count_change(tracers_before[k], particles.tracers[k], 1, reacted_[k].own);
    });
    first += rows;
  }
}

void Carrier::arrive(Particles& particles, double from, double time, StageTimes& stages) {
  if (!looks_at_steps()) {
    if (between_steps_) fold_positions(folding_, particles);  // for those who look at neighbours
    return;
  }
  if (coast_)
    stages.run("coast", [&] { ranks_.agree_on([&] { coast_->meet(began_, particles, from, time, threads_); }); });
  if (memory_.wanted())
    stages.run("exits", [&] { ranks_.agree_on([&] { memory_.add(began_, particles, from, time, threads_); }); });
  if (!departures_.possible()) return fold_positions(folding_, particles);
  settle(particles, time, stages);  // what leaves is counted with the weight that it has now
  std::int64_t some = 0;
  stages.run("edges", [&] {
    ranks_.agree_on([&] {
      fold_positions(folding_, particles);
      some = departures_.take(particles, time);
    });
    ranks_.max(std::span(&some, 1));
  });
  if (some) placed(particles);
}

void Carrier::exchange(Particles& particles, double time, double length, StageTimes& stages) const {
  for (const auto& effect : effects_)
    if (effect->acts_between_steps())
      stages.run(stage_of(*effect), [&] { call(*effect, [&] { effect->exchange(particles, time, length); }); });
}

void Carrier::scatter(Particles& particles, const Scattering& part, StageTimes& stages) const {
  for (const auto& effect : effects_) {
    if (!effect->scatters()) continue;
    stages.run(stage_of(*effect), [&] {
      const bool kept_off = coast_ && coast_->rule() == AtCoast::slide;
      const auto before = kept_off ? particles.position : decltype(particles.position){};
      call(*effect, [&] {
        effect->scatter(particles, part);
        if (kept_off) coast_->keep_off(before, particles, part.time, part.time + part.length, threads_);
      });
    });
  }
}

// Particles that stand on their nodes, with nothing integrated yet, take all steps since the others stood on theirs.
void Carrier::follow(Particles& particles) const {
  particles.path.assign(rows_of(integrals_of(integrating_)), std::vector<double>(particles.size(), 0.0));
  double now = 0;
  for (const StepsTaken::Part& taken : taken_.parts()) {
    stepper_.advance(particles, taken.interval, taken.first, taken.steps, 0);
    now = taken.interval.start(taken.first + taken.steps);
  }
  std::size_t first = 0;
  for (Effect* effect : integrating_) {
    effect->settle(particles, particles.path[first].data(), now);
    first += effect->path_integral()->rows();
  }
  fold_positions(folding_, particles);
}

void Carrier::rearrange(Particles& particles, double time, StageTimes& stages) {
  bool replaced = false;
  bring_up(particles, time, stages);
  for (const auto& effect : effects_)
    if (effect->acts_between_steps())
      stages.run(stage_of(*effect),
                 [&] { call(*effect, [&] { replaced = effect->rearrange(particles, time) || replaced; }); });
  if (!replaced) return;
  taken_.clear();
  for (const auto& effect : effects_)
    stages.run(stage_of(*effect), [&] { call(*effect, [&] { effect->begin(particles, time); }); });
  for (auto& integral : particles.path) integral.assign(particles.size(), 0.0);
}

void Carrier::land(Particles& particles, double time, StageTimes& stages) {
  fold_positions(folding_, particles);
  settle(particles, time, stages);
  bring_up(particles, time, stages);
}

void Carrier::bring_up(Particles& particles, double time, StageTimes& stages) const {
  for (const auto& effect : effects_)
    stages.run(stage_of(*effect), [&] { call(*effect, [&] { effect->land(particles, time); }); });
}

bool Carrier::keeps_neighbours() const {
  return std::none_of(effects_.begin(), effects_.end(),
                      [](const auto& effect) { return effect->changes().particles || effect->changes().neighbours; });
}

bool Carrier::replaces_particles() const {
  return std::any_of(effects_.begin(), effects_.end(), [](const auto& effect) { return effect->changes().particles; });
}

}  // namespace gaussdrift
