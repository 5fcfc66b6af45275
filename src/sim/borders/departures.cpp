#include "sim/borders/departures.hpp"

#include <algorithm>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "particle/columns.hpp"
#include "sim/borders/coast.hpp"
#include "sim/borders/open_faces.hpp"

namespace gaussdrift {

std::vector<std::unique_ptr<WayOut>> ways_out(const Case& spec) {
  std::vector<std::unique_ptr<WayOut>> ways;
  if (spec.domain.has(Edge::open)) ways.push_back(std::make_unique<OpenFaces>(spec.domain));
  if (spec.domain.coast == AtCoast::remove) ways.push_back(std::make_unique<CoastTakes>(spec));
  return ways;
}

std::vector<std::string> reasons_to_leave(const Case& spec) {
  std::vector<std::string> all;
  for (const auto& way : ways_out(spec))
    for (std::string& reason : way->reasons()) all.push_back(std::move(reason));
  return all;
}

Departures::Departures(std::vector<std::unique_ptr<WayOut>> ways, std::size_t tracers)
    : ways_(std::move(ways)), tracers_own_(tracers), tracers_together_(tracers) {
  for (const auto& way : ways_)
    for (std::string& reason : way->reasons()) reasons_.push_back(std::move(reason));
  own_.resize(reasons_.size());
  together_ = own_;
}

bool Departures::take(Particles& particles, double time) {
  std::vector<int> reason(particles.size(), WayOut::stays), of_way;
  int first = 0;  // reason of this way
  for (const auto& way : ways_) {
    of_way.assign(particles.size(), WayOut::stays);
    way->mark(particles, time, of_way);
    for (std::size_t j = 0; j < reason.size(); ++j)  // nobody leaves twice
      if (reason[j] == WayOut::stays && of_way[j] != WayOut::stays) reason[j] = first + of_way[j];
    first += static_cast<int>(way->reasons().size());
  }
  std::vector<std::size_t> staying;
  for (std::size_t j = 0; j < reason.size(); ++j) {
    if (reason[j] == WayOut::stays) {
      staying.push_back(j);
      continue;
    }
    Count& count = own_[static_cast<std::size_t>(reason[j])];
    ++count.particles;
    count.mass.add(particles.alpha[j]);
    if (see_) see_(particles, j);
    if (is_watched_ && is_watched_(particles.id[j]))
      lately_.push_back({particles.id[j], time, particles.view().at(j), reason[j]});
    for (std::size_t k = 0; k < particles.tracers.size(); ++k) tracers_own_[k].add(particles.tracers[k][j]);
  }
  if (staying.size() == particles.size()) return false;
  for_each_column(particles, [&](std::string_view, std::size_t, auto& column) {
    for (std::size_t i = 0; i < staying.size(); ++i) column[i] = column[staying[i]];
    column.resize(staying.size());
  });
  return true;
}

std::vector<Departed> Departures::so_far() const {
  std::vector<Departed> left;
  for (std::size_t r = 0; r < reasons_.size(); ++r)
    left.push_back({reasons_[r], static_cast<std::uint64_t>(together_[r].particles), together_[r].mass.value()});
  return left;
}

void Departures::bring_together(base::Communicator& ranks) {
  std::vector<std::int64_t> particles;
  std::vector<base::ExactSum> masses;
  for (const Count& count : own_) particles.push_back(count.particles), masses.push_back(count.mass);
  ranks.sum(particles);
  base::sum_over_ranks(ranks, masses);
  for (std::size_t r = 0; r < own_.size(); ++r) {
    together_[r].particles += particles[r];
    together_[r].mass.add(masses[r]);
    own_[r] = {};
  }
  base::sum_over_ranks(ranks, tracers_own_);
  for (std::size_t k = 0; k < tracers_own_.size(); ++k) {
    tracers_together_[k].add(tracers_own_[k]);
    tracers_own_[k] = {};
  }
}

void Departures::pass_state(base::StateBytes& bytes) {
  if (bytes.reading()) lately_.clear();  // in steps that were abandoned
  bytes(own_, together_);
  for (std::size_t k = 0; k < tracers_own_.size(); ++k) bytes(tracers_own_[k], tracers_together_[k]);
  const auto wrong = [](const Count& count) { return count.particles < 0; };
  if (own_.size() != reasons_.size() || together_.size() != reasons_.size() ||
      std::any_of(own_.begin(), own_.end(), wrong) || std::any_of(together_.begin(), together_.end(), wrong))
    throw std::out_of_range("what has left is not counted as here");
}

}  // namespace gaussdrift
