#include "accuracy/would_run.hpp"

#include <algorithm>
#include <variant>

#include "effect/catalogue.hpp"
#include "gaussdrift/error.hpp"
#include "gaussdrift/read_case.hpp"
#include "gaussdrift/simulation.hpp"

namespace gaussdrift::accuracy {

namespace {

/// The case without grids and tables: rules of the file are about its keys.
Case without_data(Case scene) {
  const auto dimension = static_cast<std::size_t>(scene.domain.dimension);
  for (VelocitySpec& part : scene.velocity)
    if (std::holds_alternative<FileVelocity>(part) || std::holds_alternative<GaussianVelocitySpec>(part))
      part = ExpressionVelocity{std::vector<std::string>(dimension, "0")};
  for (DensitySpec& part : scene.density)
    if (std::holds_alternative<FileDensity>(part)) part = ExpressionDensity{"1"};
  return scene;
}

std::string first_line(const std::string& text) {
  const std::string line = text.substr(0, text.find('\n')), mark = "error: ";
  return line.rfind(mark, 0) == 0 ? line.substr(mark.size()) : line;
}

}  // namespace

std::string why_not_read(const Case& scene) {
  try {
    parse_case(case_text(without_data(scene)), "run.toml");
  } catch (const Error& error) {
    return first_line(error.what());
  }
  return "";
}

std::string why_refused(const Case& scene, int threads) {
  if (std::string reason = why_not_read(scene); !reason.empty()) return reason;
  Case bare = scene;
  bare.reference = {};  // has no part in it
  try {
    Simulation(bare, threads).prepare();
  } catch (const Error& error) {
    return first_line(error.what());
  }
  return "";
}

std::string table_against_gaps(Case scene) {
  const NamedEffect* restorer = overlap_restorer();
  if (!restorer) return "";
  scene.effects.set(complete_effect(*restorer, {}));
  return why_not_read(scene).empty() ? restorers_table() : "";
}

}  // namespace gaussdrift::accuracy
