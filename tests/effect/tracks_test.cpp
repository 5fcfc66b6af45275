// [output.tracks]: who is followed, where and when, with which values, and how tracks begin and end.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "effect/scene.hpp"
#include "gaussdrift/error.hpp"
#include "message_of.hpp"
#include "ranks_of_threads.hpp"
#include "same_particles.hpp"
#include "scratch_folder.hpp"
#include "sim/scene.hpp"
#include "sim/transform.hpp"

namespace gaussdrift {
namespace {

/// All that was told of tracks, one after another.
struct Told {
  TrackSamples all;
  std::vector<Particles> outputs;
  std::vector<double> times;

  struct Row {
    double time;
    Vector place;
    std::vector<double> values;
    std::string end;
  };
  std::vector<Row> track(std::int64_t id) const {
    std::vector<Row> rows;
    const auto d = static_cast<std::size_t>(all.dimension);
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (all.id[i] != id) continue;
      Row row{all.time[i], {}, {}, all.end[i] ? all.reasons[static_cast<std::size_t>(all.end[i] - 1)] : ""};
      for (std::size_t k = 0; k < d; ++k) row.place[k] = all.place[i * d + k];
      const std::size_t width = all.components();
      row.values.assign(all.values.begin() + static_cast<std::ptrdiff_t>(i * width),
                        all.values.begin() + static_cast<std::ptrdiff_t>((i + 1) * width));
      rows.push_back(row);
    }
    return rows;
  }
  std::set<std::int64_t> ids() const { return {all.id.begin(), all.id.end()}; }
};

class Listener : public Observer {
 public:
  explicit Listener(Told& told) : told_(told) {}
  std::string name() const override { return "test"; }
  void frame(const Frame& frame) override {
    told_.outputs.push_back(*frame.particles);
    told_.times.push_back(frame.time);
  }
  void tracks(const TrackSamples& some) override {
    TrackSamples& all = told_.all;
    const auto add = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
    all.dimension = some.dimension, all.fields = some.fields, all.reasons = some.reasons;
    add(all.id, some.id), add(all.time, some.time), add(all.place, some.place), add(all.values, some.values);
    add(all.end, some.end);
  }

 private:
  Told& told_;
};

Told told_by(const Case& spec, int threads = 1) {
  Told told;
  Simulation simulation(spec, threads);
  simulation.observe(std::make_unique<Listener>(told));
  simulation.run();
  return told;
}

void expect_same(const TrackSamples& a, const TrackSamples& b) {
  EXPECT_EQ(a.id, b.id);
  EXPECT_EQ(a.time, b.time);
  EXPECT_EQ(a.place, b.place);
  EXPECT_EQ(a.end, b.end);
  ASSERT_EQ(a.values.size(), b.values.size());
  for (std::size_t i = 0; i < a.values.size(); ++i)
    EXPECT_TRUE(a.values[i] == b.values[i] || (std::isnan(a.values[i]) && std::isnan(b.values[i]))) << i;
}

const std::string turning = "velocity.u=[\"-y\", \"x\"]";

class Tracks : public testing::Test {
 protected:
  std::string points(const std::string& rows, const std::string& heading = "x,y") const {
    std::ofstream(folder_ / "points.csv") << heading << "\n" << rows;
    return "output.tracks.points=\"" + (folder_ / "points.csv").string() + "\"";
  }

  ScratchFolder folder_;
};

TEST_F(Tracks, FollowParticlesAndPointsFromLookToLook) {
  const Case spec = scene_of({turning, "particles.per_axis=21", "time={end=0.5,step=0.01}", "output.times=[0.1, 0.5]",
                              "output.tracks.every=4", "output.tracks.steps=20", "output.tracks.ids=[221]",
                              points("0.5,0\n0.25,-0.25\n")});
  const Told told = told_by(spec);
  const Particles start = seed_scene(make_scene(spec), 1);
  std::set<std::int64_t> expected{-2, -1, 221};
  for (const std::int64_t id : start.id)
    if (id % 21 % 4 == 0 && id / 21 % 4 == 0) expected.insert(id);
  EXPECT_GT(expected.size(), 10u);
  EXPECT_EQ(told.ids(), expected);
  // Both outputs, and after 20 and 40 steps.
  const std::vector<double> times{0, 0.1, 0.2, 0.4, 0.5};
  for (const std::int64_t id : expected) {
    const auto rows = told.track(id);
    ASSERT_EQ(rows.size(), 5u);
    const Vector from = rows[0].place;
    for (std::size_t i = 0; i < 5; ++i) {
      EXPECT_NEAR(rows[i].time, times[i], 1e-15);
      const double c = std::cos(times[i]), s = std::sin(times[i]);
      EXPECT_NEAR(rows[i].place[0], c * from[0] - s * from[1], 1e-10);  // rk4
      EXPECT_NEAR(rows[i].place[1], s * from[0] + c * from[1], 1e-10);
      EXPECT_EQ(rows[i].end, "");
    }
  }
  EXPECT_EQ(told.track(-2)[0].place, (Vector{0.25, -0.25, 0}));
  // Outputs show the same places, to the last bit.
  for (std::size_t output = 0; output < 2; ++output) {
    const Particles& shown = told.outputs[output];
    for (std::size_t j = 0; j < shown.size(); ++j)
      for (const auto& row : told.track(shown.id[j]))
        if (row.time == told.times[output]) {
          EXPECT_EQ(row.place[0], shown.position[0][j]);
          EXPECT_EQ(row.place[1], shown.position[1][j]);
        }
  }
}

TEST_F(Tracks, TellFieldsOfTheFlowAndTheDensityThere) {
  const Case spec = scene_of({"velocity.u=[\"-y+x*t\", \"x*x\"]", "time={end=0.3,step=0.05}", "output.times=[0.2, 0.3]",
                              "output.tracks.every=8", "output.tracks.steps=3", "evaluate.tolerance=1e-12",
                              R"(output.tracks.fields=["velocity", "rho", "vorticity", "gradient", "laplacian"])",
                              points("0.1,0.1\n")});
  const Told told = told_by(spec);
  const Scene scene = make_scene(spec);
  ASSERT_EQ(told.all.components(), 7u);
  std::size_t known = 0;
  for (const std::int64_t id : told.ids())
    for (const auto& row : told.track(id)) {
      const double x = row.place[0], y = row.place[1];
      EXPECT_EQ(row.values[0], -y + x * row.time);
      EXPECT_EQ(row.values[1], x * x);
      EXPECT_NEAR(row.values[3], 2 * x + 1, 1e-14);
      const bool is_landing = row.time == 0 || row.time == 0.2 || row.time == 0.3;
      EXPECT_EQ(std::isnan(row.values[2]), !is_landing);
      if (row.time != 0.3) continue;
      // The sum of all blobs.
      PointsView there{2, 1, {&row.place[0], &row.place[1]}};
      EXPECT_NEAR(row.values[2], sum_blobs(told.outputs.back(), scene.cutoff, there, 1)[0], 1e-14);
      const auto rho = [&](double dx, double dy) {
        const Vector beside{x + dx, y + dy, 0};
        PointsView at{2, 1, {&beside[0], &beside[1]}};
        return sum_blobs(told.outputs.back(), scene.cutoff, at, 1)[0];
      };
      constexpr double h = 1e-4;  // differences lose 1e-16 / h, and 1e-16 / h^2
      EXPECT_NEAR(row.values[4], (rho(h, 0) - rho(-h, 0)) / (2 * h), 2e-6);
      EXPECT_NEAR(row.values[5], (rho(0, h) - rho(0, -h)) / (2 * h), 2e-6);
      EXPECT_NEAR(row.values[6], (rho(h, 0) + rho(-h, 0) + rho(0, h) + rho(0, -h) - 4 * rho(0, 0)) / (h * h), 1e-4);
      ++known;
    }
  EXPECT_GT(known, 5u);
}

TEST_F(Tracks, EndWhereParticlesLeaveAndBeginWhereTheyAreReleased) {
  const Case spec =
      scene_of({edges("\"open\", \"unbounded\""), "velocity.u=[\"1\", \"0\"]", "time={end=1,step=0.1}",
                "output.times=[0, 1]", "density={expression=\"1\"}", "particles.per_axis=11", "output.tracks.every=5",
                "source.point=[-0.55, 0.25]", "source.from=0.2", "source.to=0.8", "source.rate=1", "source.puffs=4",
                "output.tracks.fields=[\"velocity\", \"rho\"]", points("0.75,0.5\n")});
  const Told told = told_by(spec);
  EXPECT_EQ(told.ids(), (std::set<std::int64_t>{-1, 0, 5, 10, 55, 60, 65, 110, 115, 120, 121}));
  for (const auto& [id, time] : std::map<std::int64_t, double>{{10, 0.1}, {-1, 0.3}, {65, 0.1}}) {
    const auto rows = told.track(id);
    ASSERT_EQ(rows.back().end, "x_max") << id;
    // The end of the first step beyond the face; steps land on releases, which shortens some.
    EXPECT_GT(rows.back().place[0], 1);
    EXPECT_NEAR(rows.back().time, time, 0.1);
    EXPECT_NEAR(rows.back().place[0], rows.front().place[0] + rows.back().time, 1e-14);
    EXPECT_EQ(rows.back().values[0], 1);
    EXPECT_TRUE(std::isnan(rows.back().values[2]));
    for (std::size_t i = 0; i + 1 < rows.size(); ++i) EXPECT_EQ(rows[i].end, "");
  }
  const auto released = told.track(121);  // the first of four, of which every fifth is followed
  EXPECT_NEAR(released.front().time, 0.275, 1e-15);
  EXPECT_EQ(released.front().place, (Vector{-0.55, 0.25, 0}));
  EXPECT_EQ(released.back().time, 1);
  EXPECT_NEAR(released.back().place[0], -0.55 + 0.725, 1e-14);
  EXPECT_EQ(told.track(5).back().end, "");
}

TEST_F(Tracks, OfARunBackwardsTellTheClockAndTheFlow) {
  const Told told = told_by(scene_of({"velocity.u=[\"t\", \"0\"]", "time={start=2,end=1.5,step=0.1}",
                                      "output.times=[1.5]", "output.tracks.every=10", "output.tracks.steps=2",
                                      "output.tracks.fields=[\"velocity\"]", points("0.5,0\n")}));
  for (const std::int64_t id : told.ids()) {
    const auto rows = told.track(id);
    ASSERT_EQ(rows.size(), 4u);
    for (std::size_t i = 0; i < 4; ++i) {
      const double t = std::max(1.5, 2 - 0.2 * static_cast<double>(i));
      EXPECT_NEAR(rows[i].time, t, 1e-15);
      EXPECT_NEAR(rows[i].place[0], rows[0].place[0] + (t * t - 4) / 2, 1e-14);
      EXPECT_NEAR(rows[i].values[0], t, 1e-15);
    }
  }
}

TEST_F(Tracks, StayInPeriodicDomains) {
  const Case spec = scene_of({edges("\"periodic\", \"periodic\""), "velocity.u=[\"2\", \"0\"]", "particles.per_axis=41",
                              "time={end=1,step=0.01}", "output.times=[1]", "density={expression=\"1\"}",
                              "output.tracks.every=20", "output.tracks.steps=7", points("0.5,0.5\n")});
  const Told told = told_by(spec);
  for (std::size_t i = 0; i < told.all.size(); ++i) {
    const double from = told.track(told.all.id[i])[0].place[0];
    EXPECT_LE(std::abs(told.all.place[2 * i]), 1);
    EXPECT_NEAR(std::remainder(told.all.place[2 * i] - from - 2 * told.all.time[i], 2), 0, 1e-13);
  }
}

struct Going {
  const char* name;
  std::vector<std::string> overrides;
};

std::vector<Going> goings() {
  return {
      {"steps", {"time.step=0.02", "output.tracks.steps=7"}},
      {"chosen", {"time={end=0.5,method=\"dopri5\",tolerance=1e-9}", "output.tracks.steps=3"}},
      {"leaving", {edges("\"open\", \"open\""), "velocity.u=[\"2+y\", \"x\"]", "output.tracks.steps=2"}},
      {"released", {"source.point=[0.3, 0.2]", "source.from=0", "source.to=0.4", "source.rate=1", "source.puffs=5"}},
      {"outputs", {}}};
}

TEST_F(Tracks, AreTheSameForThreadsRanksAndAfterAStop) {
  for (const Going& going : goings()) {
    SCOPED_TRACE(going.name);
    const Case spec = scene_of(with({turning, "particles.per_axis=61", "evaluate={per_axis=50,tile_particles=300}",
                                     "time.step=0.05", "output.times=[0, 0.3, 0.5]", "output.tracks.every=6",
                                     "output.tracks.fields=[\"velocity\", \"rho\"]", points("0.5,0\n-0.9,0.1\n")},
                                    going.overrides));
    const Told one = told_by(spec);
    ASSERT_GT(one.all.size(), 50u);
    expect_same(one.all, told_by(spec, 3).all);
    Told shared;
    on_ranks(3, [&](base::Communicator& ranks) {
      Simulation simulation(spec, 1, ranks);
      if (ranks.rank() == 0) simulation.observe(std::make_unique<Listener>(shared));
      simulation.run();
    });
    expect_same(one.all, shared.all);
    // A state after each batch of steps, or some, and another simulation that goes on from it.
    Told parts;
    const int batches = std::string(going.name) == "chosen" ? 6 : 1;
    const auto stop = [batches, n = 0](const Progress&) mutable { return ++n < batches; };
    auto part = std::make_unique<Simulation>(spec, 1);
    part->observe(std::make_unique<Listener>(parts));
    part->on_progress(stop);
    RunSummary summary = part->run();
    int stops = 0;
    for (; !summary.complete; ++stops) {
      auto next = std::make_unique<Simulation>(spec, 2);
      next->observe(std::make_unique<Listener>(parts));
      next->restore(part->particles(), part->state());
      next->on_progress(stop);
      summary = next->run();
      part = std::move(next);
    }
    EXPECT_GE(stops, 1);
    expect_same(one.all, parts.all);
  }
}

TEST_F(Tracks, DoNotChangeTheRun) {
  const std::vector<std::string> plain = {turning, "time.step=0.01", "output.times=[0, 0.5]"};
  Simulation usual(scene_of(plain), 1),
      followed(scene_of(with(plain, {"output.tracks.every=3", "output.tracks.steps=7", points("0.5,0\n")})), 1);
  usual.run(), followed.run();
  expect_same(usual.particles(), followed.particles());
}

TEST_F(Tracks, AreRefusedWhereTheyMakeNoSense) {
  const auto message = [](const std::vector<std::string>& overrides) {
    return message_of<CaseError>([&] { scene_of(overrides); });
  };
  const auto expect = [&](const std::vector<std::string>& overrides, const std::string& words) {
    const std::string found = message(overrides);
    EXPECT_NE(found.find(words), std::string::npos) << found;
  };
  expect({"output.tracks.steps=3"}, "[output.tracks] does not say who is followed");
  expect({"output.tracks.evry=3"}, "did you mean \"every\"?");
  expect({"output.tracks=3"}, "output.tracks must be one table [output.tracks]");
  expect({"output.tracks.ids=[1.5]"}, "ids are whole numbers from 0");
  expect({"output.tracks.ids=[2, 2]"}, "2 appears twice");
  expect({"output.tracks.every=3", "effects.remesh.every=2"}, "no particle can be followed with [effects.remesh]");
  expect({"output.tracks.every=3", "effects.charge.mobility=1", "output.tracks.fields=[\"velocity\"]"},
         "\"velocity\" is known of the prescribed flow alone");
  expect({points("0.5,0\n"), "effects.charge.mobility=1"}, "points go with the prescribed flow alone");
  expect({points("0.5,0\n5,0\n")}, "points.csv:3:1: the point lies outside the domain");
  expect({points("0.5,0,1\n", "x,y,z")}, "\"z\"");
  EXPECT_EQ(message({points("0.5,0\n"), "effects.remesh.every=2"}), "");
  EXPECT_EQ(message({"output.tracks.every=3", "effects.charge.mobility=1"}), "");
  EXPECT_NE(message_of<InputError>([] {
              Simulation(scene_of({"output.tracks.ids=[0]"}), 1).run();
            }).find("output.tracks.ids names 0, and no particle has that id: there is no density"),
            std::string::npos);
  EXPECT_NE(message_of<InputError>([] {
              Simulation(scene_of({"output.tracks.ids=[5000]"}), 1).run();
            }).find("the lattice has 1681 points"),
            std::string::npos);
}

TEST_F(Tracks, AreWrittenAsTheyWereRead) {
  const Case spec = scene_of({"output.tracks={ids=[820], every=5, steps=2, fields=[\"rho\"], files=[]}"});
  const std::string text = case_text(spec);
  EXPECT_NE(text.find("[output.tracks]\nids = [820]\nevery = 5\nsteps = 2\nfields = [\"rho\"]\nfiles = []\n"),
            std::string::npos)
      << text;
  EXPECT_EQ(case_text(gaussdrift::parse_case(text, "scene.toml").spec), text);
}

}  // namespace
}  // namespace gaussdrift
