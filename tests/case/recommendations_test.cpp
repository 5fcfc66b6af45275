// What a study, a hint or --accuracy recommends is copied into the case, as a user would, and has to run.
#include <gtest/gtest.h>

#include <filesystem>
#include <regex>

#include "accuracy/budget.hpp"
#include "accuracy/target.hpp"
#include "accuracy/would_run.hpp"
#include "gaussdrift/error.hpp"
#include "gaussdrift/read_case.hpp"
#include "sim/scene.hpp"
#include "sim/work.hpp"
#include "study/study.hpp"

namespace gaussdrift::study {
namespace {

namespace fs = std::filesystem;

/// All "key = value" of a text, as for --set.
std::vector<std::string> settings_in(const std::string& text) {
  static const std::regex setting(R"re(([a-z_]+\.[a-z_.]+) = ("[^"]*"|[-+0-9.e]*[0-9]))re");
  std::vector<std::string> found;
  for (std::sregex_iterator it(text.begin(), text.end(), setting), end; it != end; ++it)
    found.push_back((*it)[1].str() + "=" + (*it)[2].str());
  return found;
}

struct Reduced {
  std::string file;
  std::vector<std::string> overrides;
  Case spec(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> all = overrides;
    all.insert(all.end(), more.begin(), more.end());
    return gaussdrift::read_case(file, all).spec;
  }
  /// Why the case with these settings does not begin; empty: it does.
  std::string refusal(const std::vector<std::string>& settings) const {
    try {
      Simulation(spec(settings)).prepare();
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }
};

/// A case of the gallery, small: what is recommended for it is of no use, but it is found in the same way.
Reduced reduced(const std::string& name) {
  const std::string file = std::string(SOURCE_DIR) + "/cases/" + name + ".toml";
  const bool space = gaussdrift::read_case(file).spec.domain.dimension == 3;
  return {file,
          {std::string("particles.per_axis=") + (space ? "13" : "25"),
           std::string("evaluate.per_axis=") + (space ? "9" : "15"), "output.images=[]", "output.vtk=[]"}};
}

void expect_to_run(const Reduced& small, const std::string& text) {
  const std::vector<std::string> settings = settings_in(text);
  EXPECT_FALSE(settings.empty()) << "nothing to copy in: " << text;
  EXPECT_EQ(small.refusal(settings), "") << text;
}

class Gallery : public testing::TestWithParam<std::string> {};

TEST_P(Gallery, RunsWithWhatIsRecommended) {
  const Reduced small = reduced(GetParam());
  const Case spec = small.spec();
  const Scene scene = make_scene(spec);
  const double work = work_of(spec, scene, seed_scene(scene, 0).size()).total();
  constexpr double long_run = 4e6;  // a tenth of a second
  // The hints of check, and those of a run.
  if (work < long_run) {
    const accuracy::Budget predicted = accuracy::predict_budget(spec, scene, accuracy::Effort::whatever, 0);
    for (const std::string& advice : predicted.advice) expect_to_run(small, advice);
    if (predicted.known()) {
      accuracy::LastFrame::Kept last;
      Simulation simulation(spec);
      simulation.observe(std::make_unique<accuracy::LastFrame>(last, spec.output.times.back()));
      simulation.run();
      for (const std::string& advice :
           accuracy::measure_budget(spec, scene, last, accuracy::Effort::share_of_run, 0).advice)
        expect_to_run(small, advice);
    }
  }
  // The studies that recommend something.
  const Experiment steps = study_steps(spec, 0, 0.2);
  if (steps.conclusion.find("No method") != 0) expect_to_run(small, steps.conclusion);
  for (std::size_t i = 0; i < steps.samples.size(); ++i) {
    const Sample& sample = steps.samples[i];  // the first of a method has its longest step
    if (!sample.failure.empty() || sample.values[0] == "dopri5" ||
        (i > 0 && steps.samples[i - 1].values[0] == sample.values[0]))
      continue;
    EXPECT_EQ(small.refusal({"time.method=\"" + sample.values[0] + '"', "time.step=" + sample.values[1]}), "")
        << sample.values[0] << " " << sample.values[1] << ": a row of the table of steps";
  }
  if (spec.reference.kind == ReferenceSpec::Kind::none || work > long_run) return;
  const StudyOptions options{.file = small.file, .overrides = {}, .vary = {}, .repeats = 0};
  const Experiment lattice = study_lattice(spec, options, 0.1);
  if (lattice.conclusion.empty()) return;
  const std::size_t second = lattice.conclusion.find(';');
  expect_to_run(small, lattice.conclusion.substr(0, second));
  if (second != std::string::npos) expect_to_run(small, lattice.conclusion.substr(second));
}

TEST(Accuracy, ChoosesWhatRuns) {
  for (const char* name : {"decay", "divergent_flow"}) {
    const Reduced small = reduced(name);
    expect_to_run(small, to_text(accuracy::choose_for_accuracy(small.spec(), 0.3, 0)));
  }
}

std::vector<std::string> gallery() {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(std::string(SOURCE_DIR) + "/cases"))
    if (entry.path().extension() == ".toml") names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

INSTANTIATE_TEST_SUITE_P(Recommendations, Gallery, testing::ValuesIn(gallery()),
                         [](const auto& name) { return name.param; });

// Effects whose rules the velocity alone knows nothing of: blobs that turn each other (euler with 0.44 was recommended
// and refused), charges, an exchange between particles.
TEST(StepStudy, KnowsTheRulesOfTheEffects) {
  const Reduced kirchhoff = reduced("kirchhoff"), diffusion = reduced("shear_diffusion");
  const Experiment steps = study_steps(kirchhoff.spec(), 0, 2);
  ASSERT_FALSE(steps.samples.empty());
  EXPECT_NE(kirchhoff.refusal({"time.method=euler", "time.step=0.44"}), "");
  bool rk4 = false;
  for (const Sample& sample : steps.samples) {
    if (sample.values[0] != "rk4") continue;
    rk4 = true;
    EXPECT_GT(sample.error, 1e-9) << "the blobs do move";
  }
  EXPECT_TRUE(rk4);
  if (steps.conclusion.find("No method") != 0) expect_to_run(kirchhoff, steps.conclusion);
  Reduced exchange = diffusion;
  exchange.overrides.insert(exchange.overrides.end(), {"effects.diffusion.method=\"particle-exchange\"",
                                                       "effects.diffusion.D=0.05", "time.step=0.01"});
  const Experiment shorter = study_steps(exchange.spec(), 0, 1);
  ASSERT_FALSE(shorter.samples.empty());
  for (const Sample& sample : shorter.samples) EXPECT_NE(sample.values[0], "dopri5") << "does not go with it";
  expect_to_run(exchange, shorter.conclusion);
}

TEST(WouldRun, SaysWhatRunSays) {
  Case spec = reduced("kirchhoff").spec();
  EXPECT_EQ(accuracy::why_refused(spec, 0), "");
  spec.time.step = 0.44;
  EXPECT_NE(accuracy::why_refused(spec, 0).find("[effects.vortex]"), std::string::npos)
      << accuracy::why_refused(spec, 0);
  spec = reduced("kirchhoff").spec();
  spec.particles.cutoff = "gauss4";
  EXPECT_NE(accuracy::why_refused(spec, 0).find("needs particles.cutoff = \"gauss2\""), std::string::npos)
      << accuracy::why_refused(spec, 0);
  spec = reduced("scattered_samples").spec();  // data are not read again: not even there
  std::get<GaussianVelocitySpec>(spec.velocity[0]).file = "/nowhere/samples.csv";
  EXPECT_EQ(accuracy::why_refused(spec, 0), "");
  spec.evaluate.tolerance = 2;
  EXPECT_NE(accuracy::why_refused(spec, 0).find("evaluate.tolerance must be"), std::string::npos)
      << accuracy::why_refused(spec, 0);
}

}  // namespace
}  // namespace gaussdrift::study
