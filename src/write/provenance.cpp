#include "write/provenance.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <cstdint>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <nlohmann/json.hpp>

#include "write/atomic_file.hpp"

namespace gaussdrift::write {

namespace {

std::string processor() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);)
    if (line.rfind("model name", 0) == 0)
      if (const std::size_t colon = line.find(": "); colon != std::string::npos) return line.substr(colon + 2);
  return "unknown";
}

std::string date() {
  const char* epoch = std::getenv("SOURCE_DATE_EPOCH");
  const std::time_t now = epoch ? static_cast<std::time_t>(std::strtoll(epoch, nullptr, 10)) : std::time(nullptr);
  return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(now));
}

}  // namespace

std::string hash_of(const std::string& text) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  return fmt::format("fnv1a64:{:016x}", hash);
}

void write_provenance(const std::filesystem::path& folder, const Case& scene, const std::string& resolved,
                      const std::string& command, int threads) {
  const nlohmann::ordered_json document{{"version", GAUSSDRIFT_VERSION},
                                        {"compiler", GAUSSDRIFT_COMPILER},
                                        {"flags", GAUSSDRIFT_FLAGS},
                                        {"processor", processor()},
                                        {"threads", threads},
                                        {"command", command},
                                        {"date", date()},
                                        {"case", hash_of(scene.source)},
                                        {"resolved_case", hash_of(resolved)}};
  write_text(folder / "provenance.json", document.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
}

}  // namespace gaussdrift::write
