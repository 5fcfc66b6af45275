// What particles remember of their paths for the outputs that ask for it: how long they were in the domain, and when and
// where they left it first. Nothing is kept where no output asks. docs/data.md, "Fields of the particles".
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/communicator.hpp"
#include "base/state_bytes.hpp"
#include "gaussdrift/case.hpp"
#include "gaussdrift/particles.hpp"

namespace gaussdrift {

/// The numbers of a particle in Particles::kept, in this order.
enum class Kept : std::size_t { residence, exit_time, exit_face };
constexpr std::size_t kept_numbers = 3;

/// A particle that has left the run, with what it remembered.
struct Gone {
  std::int64_t id = 0;
  std::array<double, kept_numbers> kept{};
};

class ParticleMemory {
 public:
  explicit ParticleMemory(const Case& spec);

  /// False: nobody asks, and nothing is kept.
  bool wanted() const { return wanted_; }
  /// Particles of the start have nothing to remember.
  void begin(Particles& particles) const;

  /// Particles have gone from positions `began` to where they are, not yet folded into the domain. The way between is
  /// taken as straight, and a face as passed where it is beyond by more than rounding.
  void add(const std::array<std::vector<double>, max_dimension>& began, Particles& particles, double from, double to,
           int threads) const;

  /// Particle j leaves the run now.
  void leave(const Particles& particles, std::size_t j);
  /// Who has left the run so far, on rank 0 as of the last bring_together().
  const std::vector<Gone>& gone() const { return gone_; }
  /// All ranks call it together.
  void bring_together(base::Communicator& ranks);
  /// Who has left since then, and who had left before.
  void pass_state(base::StateBytes& bytes) { bytes(own_); }
  void pass_gone(base::StateBytes& bytes) { bytes(gone_); }

  /// exit_face of a face; 0: none yet.
  static int number_of_face(int axis, bool upper) { return 1 + 2 * axis + (upper ? 1 : 0); }

 private:
  bool wanted_ = false;
  int dimension_;
  std::array<double, max_dimension> low_{}, high_{};  // infinite along axes that fold
  std::vector<Gone> gone_;                            // brought together, on rank 0
  std::vector<Gone> own_;                             // since then
};

}  // namespace gaussdrift
