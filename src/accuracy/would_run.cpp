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
Case without_data(Case spec) {
  const auto dimension = static_cast<std::size_t>(spec.domain.dimension);
  for (VelocitySpec& part : spec.velocity)
    if (std::holds_alternative<FileVelocitySpec>(part) || std::holds_alternative<GaussianVelocitySpec>(part) ||
        std::holds_alternative<SamplesVelocitySpec>(part))
      part = ExpressionVelocitySpec{std::vector<std::string>(dimension, "0")};
  for (DensitySpec& part : spec.density)
    if (std::holds_alternative<FileDensitySpec>(part) || std::holds_alternative<SamplesDensitySpec>(part))
      part = ExpressionDensitySpec{"1"};
  return spec;
}

std::string first_line(const std::string& text) {
  const std::string line = text.substr(0, text.find('\n')), mark = "error: ";
  return line.rfind(mark, 0) == 0 ? line.substr(mark.size()) : line;
}

}  // namespace

std::string why_not_read(const Case& spec) {
  try {
    parse_case(case_text(without_data(spec)), "run.toml");
  } catch (const Error& error) {
    return first_line(error.what());
  }
  return "";
}

std::string why_refused(const Case& spec, int threads) {
  if (std::string reason = why_not_read(spec); !reason.empty()) return reason;
  Case bare = spec;
  bare.reference = {};  // has no part in it
  try {
    Simulation(bare, threads).prepare();
  } catch (const Error& error) {
    return first_line(error.what());
  }
  return "";
}

std::string table_against_gaps(Case spec) {
  const NamedEffect* restorer = overlap_restorer();
  if (!restorer || spec.effects.find(restorer->about.name)) return "";
  spec.effects.set(complete_effect(*restorer, {}));
  return why_not_read(spec).empty() ? restorers_table() : "";
}

}  // namespace gaussdrift::accuracy
