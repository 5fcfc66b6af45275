#include "write/summary.hpp"

#include <nlohmann/json.hpp>

namespace gaussdrift::write {

std::string summary_json(const Case& scene, const RunSummary& summary) {
  using json = nlohmann::ordered_json;
  json seconds;
  for (const auto& [stage, value] : summary.stages.stages()) seconds[stage] = value;
  seconds["total"] = summary.seconds;

  json frames = json::array();
  for (const auto& [time, n] : summary.frames) {
    json centroid = json::array();
    for (int k = 0; k < scene.domain.dimension; ++k) centroid.push_back(n.centroid[static_cast<std::size_t>(k)]);
    frames.push_back({{"t", time},
                      {"mass", n.mass},
                      {"minimum", n.minimum},
                      {"maximum", n.maximum},
                      {"centroid", centroid},
                      {"transform_error", n.transform_error},
                      {"evaluate_seconds", n.evaluate_seconds}});
  }

  json document{
      {"case", scene.name},
      {"title", scene.title},
      {"effects", summary.effects},
      {"particles",
       {{"lattice_points", summary.lattice_points},
        {"carried", summary.particles},
        {"spacing", summary.spacing},
        {"core_radius", summary.core_radius},
        {"cutoff", scene.particles.cutoff}}},
      {"time",
       {{"method", scene.time.method}, {"step", scene.time.step}, {"end", scene.time.end}, {"steps", summary.steps}}},
      {"evaluate",
       {{"grid_points", summary.grid_points},
        {"tolerance", summary.transform_tolerance},
        {"achievable", summary.transform_achievable},
        {"chosen", summary.transform_choice}}},
      {"threads", summary.threads},
      {"seconds", seconds},
      {"frames", frames},
  };
  return document.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

}  // namespace gaussdrift::write
