// No rank gets all particles: not for the steps and outputs of a run, not for its checkpoints, not when it goes on.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "cli/look_back.hpp"
#include "effect/scene.hpp"
#include "ranks_of_threads.hpp"
#include "same_particles.hpp"
#include "scratch_folder.hpp"
#include "write/checkpoint.hpp"

namespace gaussdrift {
namespace {

/// Looks at what arrives.
class Watched : public base::Communicator {
 public:
  Watched(base::Communicator& inner, double& most) : inner_(inner), most_(most) {}
  int rank() const override { return inner_.rank(); }
  int size() const override { return inner_.size(); }
  int hosts() const override { return inner_.hosts(); }
  int host() const override { return inner_.host(); }
  using Communicator::max;
  void sum(std::span<std::int64_t> numbers) override { inner_.sum(numbers); }
  void max(std::span<std::int64_t> numbers) override { inner_.max(numbers); }
  void broadcast(base::Bytes& bytes, int from) override { inner_.broadcast(bytes, from); }

 protected:
  std::vector<base::Bytes> deliver(std::vector<base::Bytes> out) override {
    std::vector<base::Bytes> in = inner_.exchange(std::move(out));
    double arrived = 0;
    for (const base::Bytes& bytes : in) arrived += static_cast<double>(bytes.size());
    most_ = std::max(most_, arrived);  // also what a rank sends to itself
    return in;
  }

 private:
  base::Communicator& inner_;
  double& most_;
};

/// The largest part of the bytes of all particles that a rank of four ever got at once. 25 000 particles of 32 bytes in four tiles; the
/// grid has as many bytes as 2500 of them.
double largest_part(const std::string& piece_particles) {
  const Case spec = scene_of({"particles.per_axis=301", "density.shape=\"wendland\"", "density.center=[0.05, 0.02]",
                              "density.radius=0.6", "velocity.u=[\"-y\", \"x\"]", "output.times=[0, 0.3, 0.5]",
                              "evaluate.per_axis=100", "evaluate.tile_particles=500", "particles.overlap=1",
                              "reference.kind=\"characteristics\"", "output.piece_particles=" + piece_particles});
  const ScratchFolder folder;
  std::vector<double> most(4, 0.0);
  cli::LastOutput last;
  std::size_t particles = 0, checkpoints = 0;
  on_ranks(4, [&](base::Communicator& ranks) {
    Watched watched(ranks, most[static_cast<std::size_t>(ranks.rank())]);
    const write::InHaste always = [] { return true; };  // the disk is slow
    write::CheckpointWriter writer(folder.path(), {}, {.in_haste = always, .piece_particles = 1000}, watched);
    Simulation simulation(spec, 1, watched);
    const bool first = ranks.rank() == 0;
    if (first)
      simulation.observe(cli::keep_last_output(spec, last, 1, [&] {
        return static_cast<double>(simulation.particle_count()) <= spec.output.piece_particles;
      }));
    simulation.on_progress([&](const Progress& progress) {
      writer.write("hash", progress.time, progress.steps_done, simulation.particles(), first ? simulation.state() : "");
      if (first) ++checkpoints;
      return true;
    });
    EXPECT_TRUE(simulation.run().complete);
    if (first) particles = simulation.particle_count();
  });
  EXPECT_GE(checkpoints, 2u);
  EXPECT_GT(particles, 10'000u);
  EXPECT_EQ(last.kept.any, !last.too_many);
  EXPECT_EQ(last.kept.particles.size(), last.too_many ? 0 : particles);
  on_ranks(4, [&](base::Communicator& ranks) {
    Watched watched(ranks, most[static_cast<std::size_t>(ranks.rank())]);
    std::vector<std::string> refused;
    auto checkpoint = write::read_checkpoint(folder.path(), "hash", refused, watched);
    ASSERT_TRUE(checkpoint);
    EXPECT_LT(checkpoint->particles.size(), particles / 2);
    Simulation simulation(spec, 1, watched);
    simulation.restore(std::move(checkpoint->particles), checkpoint->state);
    EXPECT_EQ(simulation.particle_count(), particles);
    EXPECT_LT(simulation.particles().size(), particles / 2);
  });
  return *std::max_element(most.begin(), most.end()) / (4 * 8.0 * static_cast<double>(particles));
}

TEST(HeldParticles, AreNeverAllOfThem) {
  EXPECT_LT(largest_part("1000"), 0.5);
  EXPECT_GT(largest_part("1000000"), 1) << "the error budget and the page get few particles as ever";
}

}  // namespace
}  // namespace gaussdrift
