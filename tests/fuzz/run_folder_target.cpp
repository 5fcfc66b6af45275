// The folder of a run: what report, render, compare, study and resume read of it, and a run that takes it over.
#include <array>

#include "fuzz_target.hpp"
#include "gaussdrift/error.hpp"
#include "gaussdrift/read_case.hpp"
#include "read/written_run.hpp"
#include "report/page.hpp"
#include "write/folder_facts.hpp"
#include "write/run_folder.hpp"

namespace gaussdrift {

namespace {

namespace fs = std::filesystem;

constexpr std::array<const char*, 10> names{"summary.json",
                                            "status.json",
                                            "provenance.json",
                                            "study.json",
                                            "density.pvd",
                                            "run.toml",
                                            "summary.png",
                                            "earlier/status.json",
                                            "density/density_0000.vti",
                                            "density/density_0001.vti"};

const fs::path& run() {
  static const fs::path folder = fuzz::folder().path() / "run";
  return folder;
}

/// What is left over from the input before must not be found by this one.
void lay_out(const fuzz::Bundle& bundle) {
  fs::remove_all(run());
  fs::create_directory(run());
  for (const char* name : names)
    if (bundle.has(name)) fuzz::folder().write("run/" + std::string(name), bundle[name]);
}

/// An error of the folder, which ends with exit code 6.
template <class Work>
void answered(const Work& work) {
  try {
    work();
  } catch (const FileError&) {
  }
}

}  // namespace

FUZZ_TARGET(run_folder) {
  static const Case spec = parse_case(R"(gaussdrift = 1
domain = {min = [-1, -1], max = [1, 1]}
velocity = {field = "rotation"}
density = {shape = "gaussian", center = [0, 0], radius = 0.3}
particles = {per_axis = 5}
time = {end = 0.5, step = 0.1}
evaluate = {per_axis = 3}
reference = {kind = "none"}
output = {times = [0, 0.2, 0.5], images = []}
)",
                                      "run.toml", {}, 1)
                               .spec;
  const fuzz::Bundle bundle(text);
  lay_out(bundle);
  if (bundle.has("study.json")) answered([] { write::files_of_study(run()); });
  if (bundle.has("provenance.json")) answered([] { write::name_of_run(run()); });
  if (bundle.has("density.pvd") || bundle.has(names.back()))
    answered([] {
      for (const read::WrittenOutput& output : read::written_outputs(run(), "density"))
        read::read_density(output.file, "rho");
    });
  if (bundle.has("summary.json")) {
    answered([] { write::says_complete(run()); });
    answered([] { report::write_report(run(), report::Pictures::not_wanted); });
  }
  if (!bundle.has("status.json") && !bundle.has("earlier/status.json")) return;
  answered([] { write::state_of_folder(run()); });
  answered([] { write::add_to_own_files(run(), {"images/a_0000.png"}); });
  for (const bool go_on : {true, false})
    answered([&] { write::RunFolder(run(), spec, {.force = !go_on, .go_on = go_on}); });
}

}  // namespace gaussdrift
