// Remeshing where the domain has edges: nodes that are images of each other are one, and only the flow takes anything out.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>

#include "effect/remesh.hpp"
#include "same_particles.hpp"
#include "scene.hpp"
#include "sim/borders/edges.hpp"

namespace gaussdrift {
namespace {

Domain domain_with(const std::string& list) {
  return scene_of({edges(list), "particles.per_axis=21"}).domain;  // 20 cells of 0.1 on each axis
}

Particles at_random(std::size_t count) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> place(-1, 1), weight(-0.3, 1);
  Particles particles;
  particles.dimension = 2;
  for (std::size_t j = 0; j < count; ++j) {
    for (int k = 0; k < 2; ++k) particles.position[k].push_back(place(random));
    particles.alpha.push_back(weight(random));
    particles.id.push_back(static_cast<std::int64_t>(j));
  }
  return particles;
}

// The copies of a coordinate in the two copies of [-1, 1] beside it.
std::vector<double> images(const std::array<Edge, 2>& ends, double x) {
  if (ends[0] == Edge::periodic) return {x, x - 2, x + 2};
  std::vector<double> all{x};
  if (ends[0] == Edge::closed) all.push_back(-2 - x);
  if (ends[1] == Edge::closed) all.push_back(2 - x);
  return all;
}

Particles with_images_written_out(const Domain& domain, const Particles& particles) {
  Particles all;
  all.dimension = 2;
  for (std::size_t j = 0; j < particles.size(); ++j)
    for (const double x : images(domain.edges[0], particles.position[0][j]))
      for (const double y : images(domain.edges[1], particles.position[1][j])) {
        all.position[0].push_back(x), all.position[1].push_back(y);
        all.alpha.push_back(particles.alpha[j]);
        all.id.push_back(static_cast<std::int64_t>(all.id.size()));
      }
  return all;
}

std::map<std::int64_t, double> weights_on_nodes(const Particles& particles) {
  std::map<std::int64_t, double> weights;
  for (std::size_t j = 0; j < particles.size(); ++j) weights[particles.id[j]] = particles.alpha[j];
  return weights;
}

double mass(const Particles& particles) {
  double sum = 0;
  for (const double alpha : particles.alpha) sum += alpha;
  return sum;
}

// Nodes get what the particles and all of their images give to them on a lattice without edges.
TEST(RemeshWithEdges, IsThatOfTheParticlesAndTheirImages) {
  for (const char* list : {R"("periodic","periodic")", R"("closed",["closed","unbounded"])", R"("periodic","closed")"})
    for (const RemeshKernel& kernel : remesh_kernels()) {
      SCOPED_TRACE(std::string(list) + " " + std::string(kernel.name));
      const Domain domain = domain_with(list);
      const Lattice lattice = seeding_lattice(domain, 21);
      Remesh folded(lattice,
                    {.kernel = std::string(kernel.name), .tolerance = 0, .ends = LatticeEnds(domain, lattice)});
      Remesh plain(lattice, {.kernel = std::string(kernel.name), .tolerance = 0});
      const Particles before = at_random(200);
      Particles particles = before, all = with_images_written_out(domain, before);
      folded.remesh(particles);
      plain.remesh(all);
      EXPECT_NEAR(mass(particles), mass(before), 4e-13);  // rounding of 200 weights
      const auto expected = weights_on_nodes(all);
      for (std::size_t j = 0; j < particles.size(); ++j) {
        if (domain.edges[1][1] == Edge::unbounded && particles.position[1][j] > 1) continue;
        ASSERT_GE(particles.id[j], 0) << "a node beyond an edge";
        EXPECT_NEAR(particles.alpha[j], expected.at(particles.id[j]), 1e-12) << particles.id[j];
      }
    }
}

TEST(RemeshWithEdges, LooksAcrossTheSeamAndIntoTheMirror) {
  // Neighbours across the seam are as far apart as any; a flow from a wall takes the particles beside it away from their
  // images.
  const auto stretch = [](const std::string& list, const std::vector<std::string>& velocity) {
    const Case spec = scene_of(with({edges(list), "particles.per_axis=21", "time.end=1", "time.step=0.05",
                                     "density.shape=\"gaussian\"", "density.radius=2"},
                                    velocity));
    const Lattice lattice = seeding_lattice(spec.domain, spec.particles.per_axis);
    return Remesh(lattice, {.ends = LatticeEnds(spec.domain, lattice)}).largest_stretch(particles_at_end(spec));
  };
  EXPECT_NEAR(stretch(R"("periodic","periodic")", {"velocity.u=[\"0.7\", \"0.3\"]"}), 1, 1e-12);
  // u = y + 1 leaves the wall y = -1 with its particles at rest there: they go from h/2 to e h/2, and the image with them.
  EXPECT_NEAR(stretch(R"("unbounded",["closed","unbounded"])", {"velocity.u=[\"0\", \"y+1\"]"}), std::exp(1.0), 1e-5);
}

TEST(RemeshWithEdges, PutsNothingBeyondAnOpenEnd) {
  const Domain domain = domain_with(R"("open",["open","closed"])");
  const Lattice lattice = seeding_lattice(domain, 21);
  Remesh remesh(lattice, {.tolerance = 0, .ends = LatticeEnds(domain, lattice)});
  Particles particles = at_random(400);
  const double before = mass(particles);
  remesh.remesh(particles);
  EXPECT_NEAR(mass(particles), before, 8e-13);
  for (std::size_t j = 0; j < particles.size(); ++j)
    for (int k = 0; k < 2; ++k) {
      EXPECT_GE(particles.position[k][j], -1 - 1e-12);
      EXPECT_LE(particles.position[k][j], 1 + 1e-12);
    }
}

TEST(RemeshWithEdges, KeepsTheErrorOfAPeriodicFlow) {
  // A shear that takes the density across both seams, with particles 3 spacings apart without remeshing.
  const std::vector<std::string> sheared{edges(R"("periodic","periodic")"),
                                         "velocity.u=[\"0.8+sin(pi*y)\", \"0.9\"]",
                                         "density.shape=\"gaussian\"",
                                         "density.center=[0, 0]",
                                         "density.radius=0.25",
                                         "particles.per_axis=81",
                                         "particles.cutoff=gauss4",
                                         "time.end=1",
                                         "time.step=0.05",
                                         "output.times=[1]",
                                         "reference.kind=characteristics"};
  const RunSummary summary = Simulation(scene_of(with(sheared, {"effects.remesh.stretch=1.3"}))).run();
  const FrameNumbers& last = summary.frames.back().second;
  EXPECT_NEAR(last.mass, summary.frames.front().second.mass, 1e-14);
  // Smoothing by gauss4: (eps^4/4) times the fourth derivatives of a Gaussian of radius 0.25 that the shear thins threefold.
  EXPECT_LT(last.error->linf, 2e-2);
}

TEST(RemeshWithEdges, OnlyTheFlowTakesOutWhatLeaves) {
  // Along an open face nothing leaves, however often nodes are renewed beside it.
  const std::vector<std::string> along{edges(R"("periodic","open")"), "velocity.u=[\"1\", \"0\"]",
                                       "density.shape=\"gaussian\"",  "density.center=[0, 0.95]",
                                       "density.radius=0.2",          "effects.remesh.every=1"};
  const RunSummary beside = Simulation(scene_of(along)).run();
  EXPECT_NEAR(beside.frames.back().second.mass, beside.frames.front().second.mass, 1e-14);
  // Through it everything leaves: what is inside and what has left is what was there.
  const std::vector<std::string> through{edges(R"("periodic","open")"),
                                         "velocity.u=[\"0\", \"1\"]",
                                         "density.shape=\"gaussian\"",
                                         "density.center=[0, 0.2]",
                                         "density.radius=0.2",
                                         "effects.remesh.every=2",
                                         "time.end=2"};
  const RunSummary gone = Simulation(scene_of(through)).run();
  const FrameNumbers& last = gone.frames.back().second;
  double left = 0;
  for (const Departed& face : last.left) left += face.mass;
  EXPECT_NEAR(left + last.mass, gone.frames.front().second.mass, 1e-14);
  EXPECT_GT(left, 0.99 * gone.frames.front().second.mass);
}

}  // namespace
}  // namespace gaussdrift
