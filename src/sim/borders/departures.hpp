// Particles that leave a run for good, counted by reason: those that pass an open face of the domain, or reach
// a coast that takes them. After every step
// the run asks each way of leaving which particles go, takes them out, and adds up their number and mass.
//
// Another way is one more class:
//   * derive it from WayOut in a file of its own: reasons() names its reasons (a column of series.csv, a row of the page
//     and a word for check.by each), mark() says which particles go now and for which of them;
//   * make it in ways_out() below, where the case asks for it.
// Everything else follows: counts are the same for any number of threads and ranks, they are kept in checkpoints, and
// they appear in FrameNumbers::left. What enters is in releases.hpp; only what leaves for good belongs here.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/communicator.hpp"
#include "base/exact_sum.hpp"
#include "base/state_bytes.hpp"
#include "gaussdrift/case.hpp"
#include "gaussdrift/frame.hpp"
#include "gaussdrift/particles.hpp"

namespace gaussdrift {

/// A way of leaving the run.
class WayOut {
 public:
  virtual ~WayOut() = default;
  /// One or more, in a fixed order: short words without blanks, that no other way has.
  virtual std::vector<std::string> reasons() const = 0;
  /// For each particle that leaves at `time`, at the end of a step: reason[j] becomes the number of its reason, from 0. It
  /// is `stays` before, and remains so for the others.
  virtual void mark(const Particles& particles, double time, std::vector<int>& reason) const = 0;

  static constexpr int stays = -1;
};

/// All ways of leaving that the case has.
std::vector<std::unique_ptr<WayOut>> ways_out(const Case& spec);

/// The reasons of all of them, as a case may name them.
std::vector<std::string> reasons_to_leave(const Case& spec);

class Departures {
 public:
  /// tracers: how many columns of Particles::tracers are counted too.
  explicit Departures(std::vector<std::unique_ptr<WayOut>> ways, std::size_t tracers = 0);

  /// False: nothing can ever leave, and nobody need ask.
  bool possible() const { return !ways_.empty(); }

  /// Takes out the particles of this rank that leave at `time`, with all that belongs to them, and counts them. Their
  /// weights must be those of that time. True if any did.
  bool take(Particles& particles, double time);

  /// From now on those whose id `is_watched` are told by left_lately() as they leave.
  void watch(std::function<bool(std::int64_t id)> is_watched) { is_watched_ = std::move(is_watched); }
  /// `see` is called with each particle that leaves, before it is taken out.
  void on_leaving(std::function<void(const Particles& particles, std::size_t j)> see) { see_ = std::move(see); }

  /// Who has left.
  struct Leaver {
    std::int64_t id = 0;
    double time = 0;
    Vector place{};
    int reason = 0;  // of reasons()
  };
  /// Those that are watched and have left on this rank since it was asked last.
  std::vector<Leaver> left_lately() { return std::exchange(lately_, {}); }
  const std::vector<std::string>& reasons() const { return reasons_; }

  /// What has left so far, by reason: on all ranks, as of the last bring_together().
  std::vector<Departed> so_far() const;

  /// What of a tracer has left so far, for whatever reason: as of the last bring_together().
  double left_of_tracer(std::size_t tracer) const { return tracers_together_[tracer].value(); }

  /// Adds up what the ranks have counted. All of them call it together.
  void bring_together(base::Communicator& ranks);

  /// What has been counted: writes it or takes it up. Once it has been brought together all ranks have the same.
  void pass_state(base::StateBytes& bytes);

 private:
  struct Count {
    std::int64_t particles = 0;
    base::ExactSum mass;
  };
  std::vector<std::unique_ptr<WayOut>> ways_;
  std::vector<std::string> reasons_;  // of all ways
  std::function<bool(std::int64_t id)> is_watched_;
  std::function<void(const Particles& particles, std::size_t j)> see_;
  std::vector<Leaver> lately_;
  std::vector<base::ExactSum> tracers_own_, tracers_together_;
  std::vector<Count> own_;       // of this rank, since they were brought together
  std::vector<Count> together_;  // of all ranks until then; the same on each
};

}  // namespace gaussdrift
