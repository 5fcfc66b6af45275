#include "sim/follow/carried_points.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string_view>

#include "particle/columns.hpp"

namespace gaussdrift {

Case CarriedPoints::without_effects(const Case& spec) {
  Case flow = spec;
  flow.effects = {};
  flow.sources.clear();
  flow.output = {};
  return flow;
}

CarriedPoints::CarriedPoints(const Case& spec, const Scene& scene, std::size_t every, int threads)
    : case_(without_effects(spec)), carrier_(case_, scene, threads) {
  carrier_.pause_every(every);
  const std::vector<double>& rows = *spec.output.tracks->points;
  points_.dimension = spec.domain.dimension;
  const auto d = static_cast<std::size_t>(points_.dimension);
  for (std::size_t row = 0; row < rows.size() / d; ++row) {
    for (std::size_t k = 0; k < d; ++k) points_.position[k].push_back(rows[row * d + k]);
    points_.alpha.push_back(0);
    points_.id.push_back(-1 - static_cast<std::int64_t>(row));
  }
}

void CarriedPoints::follow(const Carrier::Leg& leg, std::size_t steps_before, StageTimes& stages) {
  if (carrier_.is_adaptive()) {
    if (leg.now > leg_.now) carrier_.carry(points_, leg_.now, leg.now, steps_before, stages);
    leg_ = leg;
    return;
  }
  if (leg_.from != leg.from || leg_.now < leg.from) leg_ = {leg.from, leg.to, 0, leg.from};
  leg_.to = leg.to;  // an earlier output may have shortened it
  if (leg_.now >= leg.now) return;
  carrier_.carry(points_, leg_, steps_before, stages, [&](const Carrier::Leg& own) { return own.now < leg.now; });
}

void CarriedPoints::pass_state(base::StateBytes& bytes) {
  for_each_column(points_, [&](std::string_view, std::size_t, auto& column) { bytes(column); });
  bytes(leg_);
  carrier_.pass_state(bytes, points_);
  bool right = std::isfinite(leg_.now) && leg_.from >= 0 && leg_.now >= leg_.from;
  for_each_column(points_, [&](std::string_view, std::size_t, const auto& column) {
    right = right && column.size() == points_.size();
  });
  for (int k = 0; k < points_.dimension; ++k)
    right = right && std::all_of(points_.position[k].begin(), points_.position[k].end(),
                                 [](double number) { return std::isfinite(number); });
  if (!right) throw std::out_of_range("the points that it follows are not those of this case");
}

}  // namespace gaussdrift
