// What writing and reading of checkpoints share: names, manifest, raw files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "gaussdrift/particles.hpp"
#include "sim/run_state.hpp"

namespace gaussdrift::write {

constexpr unsigned checkpoint_version = newest_format;  // sim/run_state.hpp says what earlier ones have

constexpr const char* checkpoint_kind = "gaussdrift checkpoint";
constexpr const char* manifest_name = "manifest.json";
constexpr const char* state_file = "run.raw";

std::filesystem::path checkpoint_slot(const std::filesystem::path& folder, int number);
std::filesystem::path piece_file(std::size_t number);

/// Names of the columns of these particles.
nlohmann::ordered_json columns_of(const Particles& particles);

/// Of a manifest without its own check sum.
std::uint64_t sum_of_manifest(const nlohmann::ordered_json& manifest);

/// Without its own check sum, which is right. Throws std::exception.
nlohmann::ordered_json read_manifest(const std::filesystem::path& slot);

/// A member of that type; throws std::runtime_error if there is none.
const nlohmann::ordered_json& member(const nlohmann::ordered_json& object, const char* name);
std::uint64_t count_in(const nlohmann::ordered_json& object, const char* name);
double number_in(const nlohmann::ordered_json& object, const char* name);
std::string text_in(const nlohmann::ordered_json& object, const char* name);
const nlohmann::ordered_json& list_in(const nlohmann::ordered_json& object, const char* name);
[[noreturn]] void refuse_member(const char* name, const char* must_be);

/// A file that is written or read in large parts, with a check sum of all of them.
class RawFile {
 public:
  /// Reads.
  explicit RawFile(const std::filesystem::path& file);
  /// Writes.
  explicit RawFile(std::FILE* file) : own_(nullptr, &std::fclose), file_(file) {}
  void write(const void* data, std::size_t bytes);
  void read(void* data, std::size_t bytes);
  std::uint64_t sum() const { return sum_; }
  std::size_t bytes() const { return bytes_; }

 private:
  void add(const void* data, std::size_t bytes);

  std::unique_ptr<std::FILE, int (*)(std::FILE*)> own_;
  std::FILE* file_;
  std::uint64_t sum_ = 0;
  std::size_t bytes_ = 0;
};

}  // namespace gaussdrift::write
