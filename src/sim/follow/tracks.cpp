#include "sim/follow/tracks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <stdexcept>
#include <utility>

#include "base/nan.hpp"
#include "base/parallel.hpp"
#include "field/velocity/value_seconds.hpp"
#include "gaussdrift/error.hpp"
#include "sim/borders/edges.hpp"
#include "sim/flow_on_block.hpp"

namespace gaussdrift {

namespace {

using base::nan;

}  // namespace

Tracks::Tracks(const Case& spec, const Scene& scene, int threads, base::Communicator& ranks)
    : spec_(spec.output.tracks ? &*spec.output.tracks : nullptr),
      scene_(scene),
      clock_(spec.time),
      dimension_(spec.domain.dimension),
      threads_(threads),
      ranks_(ranks),
      folding_(folding_of(spec.domain)) {
  if (!spec_) return;
  ids_ = spec_->ids;
  std::sort(ids_.begin(), ids_.end());
  for (const GridField& field : spec_->fields) kinds_.push_back(&find_grid_field(field.name));
  reasons_ = reasons_to_leave(spec);
  if (spec_->points && ranks.rank() == 0) {
    points_ = std::make_unique<CarriedPoints>(spec, scene, steps(), threads);
    points_->departures().watch([](std::int64_t) { return true; });
  }
}

bool Tracks::follows(std::int64_t id) const {
  if (std::binary_search(ids_.begin(), ids_.end(), id)) return true;
  const std::int64_t every = spec_->every;
  if (every == 0) return false;
  const auto on_lattice = static_cast<std::int64_t>(scene_.seeding.size());
  if (id >= on_lattice) return (id - on_lattice) % every == 0;
  for (std::size_t k = 0; k < static_cast<std::size_t>(dimension_); ++k) {
    const auto points = static_cast<std::int64_t>(scene_.seeding.points[k]);
    if (id % points % every != 0) return false;
    id /= points;
  }
  return true;
}

void Tracks::check_ids(const Particles& particles, std::int64_t released_before) const {
  std::vector<std::int64_t> there(ids_.size());
  const auto on_lattice = static_cast<std::int64_t>(scene_.seeding.size());
  for (std::size_t i = 0; i < ids_.size(); ++i)
    there[i] = (ids_[i] >= on_lattice && ids_[i] < released_before) ||
               std::binary_search(particles.id.begin(), particles.id.end(), ids_[i]);
  ranks_.max(there);
  for (std::size_t i = 0; i < ids_.size(); ++i)
    if (there[i] == 0)
      throw InputError(fmt::format(
          "output.tracks.ids names {}, and no particle has that id: {}. The files of the particles tell their ids",
          ids_[i],
          ids_[i] < on_lattice           ? "there is no density at this point of the lattice"
          : released_before > on_lattice ? "sources do not release so many"
                                         : fmt::format("the lattice has {} points", on_lattice)));
}

void Tracks::leave(const std::vector<Departures::Leaver>& leavers, const std::vector<std::string>& reasons) {
  for (const Departures::Leaver& leaver : leavers) {
    const auto number = std::find(reasons_.begin(), reasons_.end(), reasons[static_cast<std::size_t>(leaver.reason)]);
    left_.push_back({leaver.id, leaver.time, leaver.place, 1 + (number - reasons_.begin())});
  }
}

void Tracks::follow(const Carrier::Leg& leg, std::size_t steps_before, StageTimes& stages) {
  if (!points_) return;
  StageTimes own;
  points_->follow(leg, steps_before, own);
  double seconds = 0;
  for (const auto& [stage, spent] : own.stages()) seconds += spent;
  stages.add("tracks", seconds);
  leave(points_->departures().left_lately(), points_->departures().reasons());
}

std::vector<DensityDerivatives> Tracks::derivatives() const {
  std::vector<DensityDerivatives> all;
  for (const GridFieldKind* kind : kinds_)
    if (kind->of_density)
      for (DensityDerivatives& component : kind->of_density(dimension_)) all.push_back(std::move(component));
  return all;
}

std::vector<Tracks::Row> Tracks::rows_of(const Particles& particles, double time) const {
  std::vector<Row> rows;
  for (std::size_t j = 0; j < particles.size(); ++j) {
    if (particles.id[j] >= 0 && !follows(particles.id[j])) continue;
    Row row{particles.id[j], time, {}, 0};
    for (int k = 0; k < dimension_; ++k) {  // on a leg they are not folded yet
      const auto axis = static_cast<std::size_t>(k);
      row.place[axis] = folding_.fold(k, particles.position[axis][j]).x;
    }
    rows.push_back(row);
  }
  return rows;
}

std::vector<Tracks::Row> Tracks::gathered(const std::vector<Row>& own) const {
  if (ranks_.size() == 1) return own;
  std::vector<Row> all;
  for (const base::Bytes& bytes : ranks_.gather(base::to_bytes(own)))
    for (const Row& row : base::from_bytes<Row>(bytes)) all.push_back(row);
  return all;
}

void Tracks::bring_together() {
  if (ranks_.size() > 1) left_ = gathered(left_);
}

TrackSamples Tracks::look(const Particles& particles, double time, const DensityAt& density_at) {
  TrackSamples samples;
  if (time <= looked_) return samples;
  looked_ = time;
  bring_together();
  std::vector<Row> living = gathered(rows_of(particles, time));
  const bool has_density =
      density_at && std::any_of(kinds_.begin(), kinds_.end(), [](const GridFieldKind* kind) { return !kind->of_flow; });
  if (ranks_.rank() == 0) {
    if (points_)
      for (const Row& row : rows_of(points_->points(), time)) living.push_back(row);
    std::sort(living.begin(), living.end(), [](const Row& a, const Row& b) { return a.id < b.id; });
    std::sort(left_.begin(), left_.end(),
              [](const Row& a, const Row& b) { return a.time != b.time ? a.time < b.time : a.id < b.id; });
  }
  std::vector<Row> rows = std::exchange(left_, {});
  const std::size_t left = rows.size();
  rows.insert(rows.end(), living.begin(), living.end());
  samples.dimension = dimension_;
  samples.reasons = reasons_;
  for (const GridFieldKind* kind : kinds_) samples.fields.emplace_back(kind->about.name, kind->components(dimension_));
  for (const Row& row : rows) {
    samples.id.push_back(row.id);
    samples.time.push_back(clock_.at(row.time));
    samples.place.insert(samples.place.end(), row.place.begin(), row.place.begin() + dimension_);
    samples.end.push_back(static_cast<int>(row.end));
  }
  samples.values.assign(samples.size() * samples.components(), nan);
  if (has_density) add_density(rows, left, density_at, samples);
  ranks_.agree_on([&] {
    for (std::size_t first = 0, count = 0; first < rows.size(); first += count) {
      for (count = 1; first + count < rows.size() && rows[first + count].time == rows[first].time;) ++count;
      add_flow(first, count, samples);
    }
  });
  return samples;
}

// Places `first` and after are those of this time.
void Tracks::add_density(const std::vector<Row>& rows, std::size_t first, const DensityAt& density_at,
                         TrackSamples& samples) const {
  std::vector<double> points;
  for (std::size_t i = first; i < rows.size(); ++i)
    points.insert(points.end(), rows[i].place.begin(), rows[i].place.begin() + dimension_);
  const std::vector<std::vector<double>> sums = density_at(points);
  if (sums.empty()) return;  // on another rank
  const std::size_t width = samples.components();
  std::size_t column = 0, next = 1;
  for (const GridFieldKind* kind : kinds_) {
    const auto components = static_cast<std::size_t>(kind->components(dimension_));
    for (std::size_t c = 0; c < components && !kind->of_flow; ++c) {
      const std::vector<double>& sum = sums[kind->of_density ? next++ : 0];
      for (std::size_t i = first; i < rows.size(); ++i) samples.values[i * width + column + c] = sum[i - first];
    }
    column += components;
  }
}

// At places that have one time.
void Tracks::add_flow(std::size_t first, std::size_t count, TrackSamples& samples) const {
  const auto of_flow = [](const GridFieldKind* kind) { return kind->of_flow != nullptr; };
  if (count == 0 || std::none_of(kinds_.begin(), kinds_.end(), of_flow)) return;
  const bool with_gradient =
      std::any_of(kinds_.begin(), kinds_.end(), [](const GridFieldKind* kind) { return kind->needs_gradient; });
  const VelocityField& velocity = scene_.velocity->shown();
  const std::size_t block = velocity.evaluates_in_blocks() ? std::min<std::size_t>(512, count) : count;
  const auto d = static_cast<std::size_t>(dimension_);
  const std::size_t width = samples.components();
  base::parallel_for(
      {(count + block - 1) / block, static_cast<double>(count) * value_seconds(velocity) * (with_gradient ? 4 : 1)},
      threads_, [&] { return FlowOnBlock(dimension_, block, with_gradient); },
      [&](FlowOnBlock& flow, std::size_t number) {
        const std::size_t begin = first + number * block, length = std::min(block, first + count - begin);
        flow.evaluate(velocity, samples.time[first], length,
                      [&](std::size_t k, std::size_t j) { return samples.place[(begin + j) * d + k]; });
        for (std::size_t j = 0; j < length; ++j) {
          double* to = samples.values.data() + (begin + j) * width;
          for (const GridFieldKind* kind : kinds_) {
            if (kind->of_flow) kind->of_flow(flow.at(j), to);
            to += kind->components(dimension_);
          }
        }
      });
}

void Tracks::pass_state(base::StateBytes& bytes) {
  bytes(looked_, left_);
  for (const Row& row : left_)
    if (row.end < 1 || row.end > static_cast<std::int64_t>(reasons_.size()))
      throw std::out_of_range("tracks have ended for reasons that this case does not have");
  std::string of_points;
  if (points_ && !bytes.reading()) {
    base::StateBytes own;
    points_->pass_state(own);
    of_points = own.written();
  }
  bytes(of_points);
  if (!points_ || !bytes.reading()) return;
  base::StateBytes own(of_points);
  points_->pass_state(own);
  own.end();
}

}  // namespace gaussdrift
