// Checkpoints: manifest, particles and what a run has gathered, read and gone on with. The check sums are mended, for a
// stranger can do that too.
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "fuzz_target.hpp"
#include "gaussdrift/read_case.hpp"
#include "gaussdrift/simulation.hpp"
#include "write/checkpoint.hpp"

namespace gaussdrift {

namespace {

using json = nlohmann::ordered_json;
using fuzz::Bundle;

constexpr std::array<const char*, 3> raw_files{"particles_0000.raw", "particles_0001.raw", "run.raw"};
constexpr const char* outputs_file = "outputs.raw";

struct Kind {
  const char* name;
  std::vector<std::string> overrides;
};

/// A few particles each: what a state holds depends on the effects.
const std::map<std::string, Case, std::less<>>& cases() {
  static const std::map<std::string, Case, std::less<>> all = [] {
    const std::string chosen = "time.method=dopri5",
                      tolerance = "time.tolerance=1e-6";  // begins faster than fixed steps
    const std::vector<Kind> kinds{{"transport", {}},
                                  {"adaptive", {chosen, tolerance}},
                                  {"reaction", {chosen, tolerance, "effects.reaction.rate=x+1"}},
                                  {"core_spreading", {chosen, tolerance, "effects.diffusion.D=0.01"}},
                                  {"exchange",
                                   {"particles.per_axis=3", "particles.overlap=1", "effects.diffusion.D=0.00001",
                                    "effects.diffusion.method=particle-exchange"}},
                                  {"remesh", {"particles.per_axis=3", "effects.remesh.every=2"}},
                                  {"charge", {chosen, tolerance, "effects.charge.mobility=0.3"}},
                                  {"vortex", {chosen, tolerance, "effects.vortex.tolerance=1e-6"}}};
    std::map<std::string, Case, std::less<>> made;
    for (const Kind& kind : kinds)
      made[kind.name] = parse_case(R"(gaussdrift = 1
domain = {min = [-1, -1], max = [1, 1]}
velocity = {field = "rotation"}
density = {shape = "gaussian", center = [0, 0], radius = 0.3}
particles = {per_axis = 5}
time = {end = 0.5, step = 0.1}
evaluate = {per_axis = 3, method = "direct"}
reference = {kind = "none"}
output = {times = [0, 0.2, 0.5], images = [], vtk = [], report = "none"}
)",
                                   "checkpoint.toml", kind.overrides, 1)
                            .spec;
    return made;
  }();
  return all;
}

std::uint64_t sum_of(std::string_view bytes) {
  return crc32_z(crc32_z(0, nullptr, 0), reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
}

/// With the check sums of the files that it names; `sizes`: and with their sizes.
void mend(const Bundle& bundle, bool sizes, json& entry) {
  if (!entry.is_object() || !entry.contains("file") || !entry["file"].is_string()) return;
  const std::string_view bytes = bundle[entry["file"].get<std::string>()];
  entry["crc32"] = sum_of(bytes);
  if (sizes) entry["bytes"] = bytes.size();
}

/// Empty if it is no JSON that can be mended.
std::string mended(const Bundle& bundle, bool sizes) {
  const std::string_view text = bundle["manifest.json"];
  json manifest = json::parse(text, nullptr, false);
  constexpr std::ptrdiff_t deep = 100;  // json::dump() calls itself as deep as it is nested
  if (!manifest.is_object() ||
      std::count(text.begin(), text.end(), '[') + std::count(text.begin(), text.end(), '{') > deep)
    return "";
  if (manifest.contains("pieces") && manifest["pieces"].is_structured())
    for (json& piece : manifest["pieces"]) mend(bundle, sizes, piece);
  if (manifest.contains("state")) mend(bundle, sizes, manifest["state"]);
  if (manifest.contains("outputs") && manifest["outputs"].is_object()) {
    json& outputs = manifest["outputs"];
    const std::string_view bytes = bundle[outputs_file];
    if (sizes || !outputs.contains("bytes") || !outputs["bytes"].is_number_unsigned()) outputs["bytes"] = bytes.size();
    outputs["crc32"] = sum_of(bytes.substr(0, outputs["bytes"].get<std::size_t>()));
  }
  manifest.erase("crc32");
  manifest["crc32"] = sum_of(manifest.dump());
  return manifest.dump();
}

std::string past_in(std::string_view manifest) {
  const json all = json::parse(manifest, nullptr, false);
  return all.is_object() && all.contains("case") && all["case"].is_string() ? all["case"].get<std::string>() : "";
}

/// Restored into a run of its kind, which takes a few steps.
void go_on(const Case& spec, write::Checkpoint checkpoint) {
  Simulation simulation(spec, 1);
  simulation.restore(std::move(checkpoint.particles), checkpoint.state);
  // Far apart, particles make the bound of the density's error look at a million boxes: bounded, but slow to fuzz.
  for (const auto& axis : simulation.particles().position)
    if (std::any_of(axis.begin(), axis.end(), [](double x) { return std::abs(x) > 100; })) return;
  int calls = 0;
  simulation.on_progress([&](const Progress&) { return ++calls < 2; });
  simulation.run();
  simulation.state();
}

/// False if it is refused as a checkpoint.
bool read_and_go_on(std::string_view manifest, std::string_view kind) {
  fuzz::folder().write("state/0/manifest.json", manifest);
  std::vector<std::string> refused;
  base::Communicator alone;
  auto checkpoint = write::read_checkpoint(fuzz::folder().path(), past_in(manifest), refused, alone);
  if (!checkpoint) return false;
  const auto named = cases().find(kind);
  if (named == cases().end()) return true;
  try {
    go_on(named->second, std::move(*checkpoint));
  } catch (const InputError&) {
  } catch (const NumericalError&) {
  }
  return true;
}

}  // namespace

FUZZ_TARGET(checkpoint) {
  const Bundle bundle(text);
  for (const char* name : raw_files)
    if (const std::string file = std::string("state/0/") + name; bundle.has(name))
      fuzz::folder().write(file, bundle[name]);
    else
      std::filesystem::remove(fuzz::folder().path() / file);
  fuzz::folder().write(std::string("state/") + outputs_file, bundle[outputs_file]);
  const std::string_view kind = bundle["kind"];
  if (read_and_go_on(bundle["manifest.json"], kind)) return;
  for (const bool sizes : {false, true})
    if (const std::string manifest = mended(bundle, sizes); !manifest.empty() && read_and_go_on(manifest, kind)) return;
}

}  // namespace gaussdrift
