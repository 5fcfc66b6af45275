// The tracks of a run, [output.tracks] of a case: whom it follows, when it looks at them, and what it tells of them.
// docs/data.md, "Tracks".
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "base/communicator.hpp"
#include "base/folding.hpp"
#include "base/state_bytes.hpp"
#include "gaussdrift/case.hpp"
#include "gaussdrift/particles.hpp"
#include "gaussdrift/stage_times.hpp"
#include "gaussdrift/tracks.hpp"
#include "sim/borders/departures.hpp"
#include "sim/carrier.hpp"
#include "sim/follow/carried_points.hpp"
#include "sim/grid_fields.hpp"
#include "sim/scene.hpp"
#include "sim/transform.hpp"

namespace gaussdrift {

class Tracks {
 public:
  /// Case and scene must outlive it.
  Tracks(const Case& spec, const Scene& scene, int threads, base::Communicator& ranks);

  /// False: nobody is followed, and nobody need ask.
  bool wanted() const { return spec_ != nullptr; }
  /// Steps between looks; 0: at landings alone.
  std::size_t steps() const { return wanted() ? static_cast<std::size_t>(spec_->steps) : 0; }
  bool follows(std::int64_t id) const;

  /// Refuses (InputError) ids that no particle has: neither one of the start nor one that is released. All ranks call it.
  void check_ids(const Particles& particles, std::int64_t released_before) const;

  /// Particles that are followed have left.
  void leave(const std::vector<Departures::Leaver>& leavers, const std::vector<std::string>& reasons);
  /// The points of the table go to where the particles are. On rank 0.
  void follow(const Carrier::Leg& leg, std::size_t steps_before, StageTimes& stages);

  /// The density and its derivatives at some points [j][dimension] of rank 0, as density_at_points() gives them.
  using DensityAt = std::function<std::vector<std::vector<double>>(const std::vector<double>& points)>;
  /// Derivatives that density_at must give.
  std::vector<DensityDerivatives> derivatives() const;
  /// Where all that are followed are at the elapsed `time`, and those that have left since the last look. density_at: null where
  /// weights are not those of this time; then the density is NaN. On rank 0; all ranks call it together. Nothing where
  /// it has looked at this time before.
  TrackSamples look(const Particles& particles, double time, const DensityAt& density_at);

  /// Who has left on any rank since the last look, to rank 0.
  void bring_together();
  /// Where points are, and who has left since the last look: writes it, or takes it up.
  void pass_state(base::StateBytes& bytes);

 private:
  struct Row {
    std::int64_t id = 0;
    double time = 0;
    Vector place{};
    std::int64_t end = 0;
  };
  std::vector<Row> rows_of(const Particles& particles, double time) const;
  std::vector<Row> gathered(const std::vector<Row>& own) const;
  void add_flow(std::size_t first, std::size_t count, TrackSamples& samples) const;
  void add_density(const std::vector<Row>& rows, std::size_t first, const DensityAt& density_at,
                   TrackSamples& samples) const;

  const TracksSpec* spec_ = nullptr;  // null: nobody is followed
  const Scene& scene_;
  const TimeSpec& clock_;  // rows have elapsed times until they are told
  int dimension_;
  int threads_;
  base::Communicator& ranks_;
  Folding folding_;
  std::vector<std::int64_t> ids_;  // ascending
  std::vector<const GridFieldKind*> kinds_;
  std::vector<std::string> reasons_;
  std::unique_ptr<CarriedPoints> points_;                     // on rank 0, with a table
  std::vector<Row> left_;                                     // since the last look
  double looked_ = -std::numeric_limits<double>::infinity();  // the time of the last look
};

}  // namespace gaussdrift
