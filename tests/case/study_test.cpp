// Studies: what is varied, observed orders, the front, and rows that say why they failed.
#include "study/study.hpp"
#include "parsed_json.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "case_text.hpp"
#include "gaussdrift/error.hpp"
#include "gaussdrift/read_case.hpp"
#include "scratch_folder.hpp"

namespace gaussdrift::study {
namespace {

const std::string cases = std::string(SOURCE_DIR) + "/cases/";

TEST(Variation, IsSplitAtCommasOutsideOfListsAndQuotes) {
  const Variation plain = parse_variation("time.step=0.1,pi/100"),
                  lists = parse_variation("density.center=[0, 1],[0.5, f(1, 2)]");
  EXPECT_EQ(plain.key, "time.step");
  EXPECT_EQ(plain.values, (std::vector<std::string>{"0.1", "pi/100"}));
  EXPECT_EQ(lists.values, (std::vector<std::string>{"[0, 1]", "[0.5, f(1, 2)]"}));
  for (const char* wrong : {"time.step", "=1,2", "time.step=", "time.step=1,,2"})
    EXPECT_THROW(parse_variation(wrong), CommandLineError) << wrong;
}

TEST(Experiment, KnowsItsFrontAndItsOrders) {
  Case spec;
  spec.time.method = "rk4";
  Experiment experiment;
  experiment.keys = {"time.step"};
  for (const auto& [step, error, seconds] :
       {std::tuple{"0.4", 16e-4, 1.0}, {"0.2", 1e-4, 2.0}, {"0.1", 1e-4 / 16, 4.0}, {"0.05", 1e-4, 8.0}}) {
    Sample sample;
    sample.values = {step};
    sample.error = error;
    sample.seconds = seconds;
    experiment.samples.push_back(sample);
  }
  finish(experiment, spec);
  EXPECT_NEAR(experiment.samples[1].order, 4, 1e-14);
  EXPECT_NEAR(experiment.samples[2].order, 4, 1e-14);
  EXPECT_TRUE(experiment.samples[2].on_front);
  EXPECT_FALSE(experiment.samples[3].on_front);
}

TEST(Study, VariesKeysAndKeepsWhatCannotRun) {
  StudyOptions options;
  options.file = cases + "decay.toml";
  options.overrides = {"particles.per_axis=60", "evaluate.per_axis=41", "time.end=1", "output.times=[1]"};
  options.vary = {parse_variation("particles.cutoff=gauss2,gauss4"),
                  parse_variation("particles.per_axis=50,100,0.5*300")};
  options.repeats = 1;
  std::size_t told = 0;
  options.table_grew = [&](const Experiment& experiment) {
    ++told;
    EXPECT_EQ(experiment.samples.size(), told);
  };
  const Study study = run_study(options);
  ASSERT_EQ(study.experiments.size(), 1u);
  const Experiment& experiment = study.experiments[0];
  ASSERT_EQ(experiment.samples.size(), 6u);
  EXPECT_EQ(told, 6u);
  options.table_grew = {};
  for (const Sample& sample : experiment.samples) {
    EXPECT_EQ(sample.failure, "");
    EXPECT_GT(sample.seconds, 0);
    EXPECT_GT(sample.l1, 0);
    EXPECT_GT(sample.l2, 0);
  }
  EXPECT_GT(experiment.samples[1].order, 1) << "positive where a finer lattice is better";
  ASSERT_EQ(experiment.notes.size(), 1u);
  EXPECT_NE(experiment.notes[0].find("2 with gauss2; 4 with gauss4"), std::string::npos) << experiment.notes[0];
  EXPECT_LT(experiment.samples[4].error, experiment.samples[1].error) << "gauss4 at the same lattice";
  EXPECT_FALSE(experiment.conclusion.empty());
  const auto json = parsed_json(to_json(study));
  EXPECT_EQ(json["experiments"][0]["samples"].size(), 6u);
  EXPECT_EQ(json["experiments"][0]["samples"][0]["particles.cutoff"], "gauss2");
  EXPECT_GT(json["experiments"][0]["samples"][0]["L1"], 0);
  EXPECT_NE(to_csv(study).find("study,particles.cutoff=gauss2 particles.per_axis=50,"), std::string::npos);
  const std::string csv = to_csv(experiment);
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 7);

  options.vary = {parse_variation("particles.overlap=2,-1,3")};
  const Study wrong = run_study(options);
  EXPECT_EQ(wrong.experiments[0].samples[0].failure, "");
  EXPECT_NE(wrong.experiments[0].samples[1].failure.find("particles.overlap"), std::string::npos);
  EXPECT_EQ(wrong.experiments[0].samples[2].failure, "");

  options.file = cases + "rotating_cone.toml";
  options.overrides = {"particles.per_axis=40", "evaluate.per_axis=21", "output.times=[0, \"2*pi\"]"};
  options.vary = {parse_variation("time.step=0.1,3")};
  const Study stiff = run_study(options);
  EXPECT_EQ(stiff.experiments[0].samples[0].failure, "");
  EXPECT_NE(stiff.experiments[0].samples[1].failure.find("amplifies a pure rotation"), std::string::npos);
}

// A cone that has been blown out of the domain at the end: no lattice and no target changes that.
TEST(Study, ConcludesNothingFromRunsWithNothingLeft) {
  const Case blown = gaussdrift::parse_case(case_text({.domain = unit_square,
                                                       .velocity = velocity_of({"1", "0"}),
                                                       .density = shape_of("wendland", "0.5, 0.5", "0.2"),
                                                       .particles = "per_axis = 20",
                                                       .time = "end = 2\nstep = 0.1",
                                                       .evaluate = "per_axis = 11",
                                                       .output = "times = [2]\nimages = []"}),
                                            "blown.toml")
                         .spec;
  StudyOptions options;
  options.repeats = 0;
  for (const Experiment& experiment : {study_lattice(blown, options, 0.1), study_whole(blown, options, 0.1)}) {
    EXPECT_EQ(experiment.conclusion,
              "No run has a known error: nothing is left to compare (all of the mass has left the domain).");
    for (const std::string& note : experiment.notes) EXPECT_EQ(note.find("smooth"), std::string::npos) << note;
  }
}

TEST(Study, RefusesWhatItCannotVary) {
  StudyOptions options;
  options.file = cases + "decay.toml";
  options.vary = {parse_variation("output.times=[1],[2]")};
  EXPECT_THROW(run_study(options), CommandLineError);
  options.vary = {parse_variation("time.step=0.1"), parse_variation("time.step=0.2")};
  EXPECT_THROW(run_study(options), CommandLineError);
  const ScratchFolder folder;
  const std::filesystem::path alone = folder / "nothing_to_compare.toml";
  write_file(alone, case_text({.reference = not_compared}));
  options.file = alone;
  options.overrides = {};
  options.vary = {parse_variation("time.step=0.1")};
  try {
    run_study(options);
    FAIL() << "nothing to compare with";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("no exact density"), std::string::npos) << error.what();
  }
  options.file = cases + "decay.toml";
  options.overrides = {};
  options.vary = {parse_variation("particles.per_axes=10,20")};
  EXPECT_THROW(run_study(options), InputError);
}

TEST(Study, OfSourcesVariesKeysAlone) {
  StudyOptions options;
  options.file = cases + "plume.toml";
  try {
    run_study(options);
    FAIL() << "the standard studies know nothing of what is released later";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("[[source]]"), std::string::npos) << error.what();
  }
}

TEST(StandardStudies, SeeTheOrdersOfTheMethods) {
  const Case spec = read_case(cases + "rotating_cone.toml", {"particles.per_axis=60"}).spec;
  const Experiment steps = study_steps(spec, 0, 5);
  for (const std::string wanted : {"euler: observed order 1.0", "heun: observed order 2.0", "rk4: observed order 4.0"})
    EXPECT_TRUE(std::any_of(steps.notes.begin(), steps.notes.end(), [&](const std::string& note) {
      return note.find(wanted) == 0;
    })) << wanted;
  EXPECT_NE(steps.conclusion.find("thousandth"), std::string::npos);
}

TEST(StandardStudies, SeeTheOrdersOfTheCutoffs) {
  // A Gaussian is smooth, so its smoothing falls with the cutoff's order: 2, 4, 6, 8.
  for (const auto& [cutoff, order] : {std::pair{"gauss2", 2}, {"gauss4", 4}, {"gauss6", 6}, {"gauss8", 8}}) {
    StudyOptions options;
    options.file = cases + "rotating_cone.toml";
    options.overrides = {
        "density.shape=gaussian",   "density.radius=0.17", "density.center=[0, 0]",
        "evaluate.per_axis=21",     "time.end=0.1",        "time.step=0.1",
        "evaluate.tolerance=1e-13", "output.times=[0]",    std::string("particles.cutoff=\"") + cutoff + '"'};
    options.vary = {parse_variation("particles.per_axis=121,241")};
    options.repeats = 0;
    const Study study = run_study(options);
    EXPECT_NEAR(study.experiments[0].samples[1].order, order, 0.34) << cutoff;  // the next term: k (eps/R)^2 = 0.4
  }
}

}  // namespace
}  // namespace gaussdrift::study
