#include "sim/follow/particle_memory.hpp"

#include <limits>

#include "base/has_one.hpp"
#include "base/parallel.hpp"
#include "sim/borders/edges.hpp"
#include "sim/follow/particle_fields.hpp"

namespace gaussdrift {

namespace {

/// The part of a straight way that is inside of a box, from 0 to 1, and the face through which it leaves; 0: none.
struct Inside {
  double from = 0, to = 1;
  int face = 0;
};

}  // namespace

ParticleMemory::ParticleMemory(const Case& spec) : wanted_(remembers(spec.output)), dimension_(spec.domain.dimension) {
  const Folding folding = folding_of(spec.domain);
  const double rounding = rounding_of(spec.domain);
  for (int k = 0; k < dimension_; ++k) {
    const auto axis = static_cast<std::size_t>(k);
    const FoldedAxis& folded = folding.axis(k);
    constexpr double never = std::numeric_limits<double>::infinity();
    low_[axis] = folded.periodic || folded.mirror_low ? -never : spec.domain.min[axis] - rounding;
    high_[axis] = folded.periodic || folded.mirror_high ? never : spec.domain.max[axis] + rounding;
  }
}

void ParticleMemory::begin(Particles& particles) const {
  if (wanted_) particles.kept.assign(kept_numbers, std::vector<double>(particles.size(), 0.0));
}

void ParticleMemory::add(const std::array<std::vector<double>, max_dimension>& began, Particles& particles, double from,
                         double to, int threads) const {
  const auto kept = [&](Kept what) -> std::vector<double>& { return particles.kept[static_cast<std::size_t>(what)]; };
  constexpr std::size_t block = 4096;
  const std::size_t count = particles.size();
  const auto add_block = [&](std::size_t b) {
    for (std::size_t j = b * block, end = std::min(count, j + block); j < end; ++j) {
      Inside inside;
      for (std::size_t k = 0; k < static_cast<std::size_t>(dimension_); ++k) {
        const double a = began[k][j], way = particles.position[k][j] - a;
        if (way == 0) {
          if (a < low_[k] || a > high_[k]) inside.to = -1;
          continue;
        }
        const double first = ((way > 0 ? low_[k] : high_[k]) - a) / way,
                     last = ((way > 0 ? high_[k] : low_[k]) - a) / way;
        inside.from = std::max(inside.from, first);
        if (last < inside.to) inside.to = last, inside.face = number_of_face(static_cast<int>(k), way > 0);
      }
      if (!(inside.to >= inside.from)) continue;
      kept(Kept::residence)[j] += (inside.to - inside.from) * (to - from);
      if (inside.face == 0 || kept(Kept::exit_face)[j] != 0) continue;
      kept(Kept::exit_time)[j] = from + inside.to * (to - from);
      kept(Kept::exit_face)[j] = inside.face;
    }
  };
  constexpr double seconds_of_a_particle = 1e-8;
  base::parallel_for({(count + block - 1) / block, static_cast<double>(count) * seconds_of_a_particle}, threads,
                     add_block);
}

void ParticleMemory::leave(const Particles& particles, std::size_t j) {
  Gone gone{particles.id[j], {}};
  for (std::size_t q = 0; q < kept_numbers; ++q) gone.kept[q] = particles.kept[q][j];
  own_.push_back(gone);
}

void ParticleMemory::bring_together(base::Communicator& ranks) {
  for (const base::Bytes& bytes : ranks.gather(base::to_bytes(own_)))
    for (const Gone& gone : base::from_bytes<Gone>(bytes)) gone_.push_back(gone);
  own_.clear();
}

}  // namespace gaussdrift
