#include "write/checkpoint.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <zlib.h>

#include <cstdint>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <tuple>
#include <vector>

#include "gaussdrift/error.hpp"
#include "same_particles.hpp"
#include "scratch_folder.hpp"
#include "write/disk.hpp"

namespace gaussdrift::write {
namespace {

namespace fs = std::filesystem;

Particles some_particles(std::size_t count, double first) {
  Particles particles;
  for (std::size_t j = 0; j < count; ++j) {
    particles.position[0].push_back(first + 0.1 * static_cast<double>(j));
    particles.position[1].push_back(-static_cast<double>(j));
    particles.alpha.push_back(1.0 / static_cast<double>(j + 3));
    particles.id.push_back(static_cast<std::int64_t>(count - j) - 2);
  }
  particles.path.assign(1, std::vector<double>(count, 0.25));
  particles.volume.assign(count, 0.5);
  particles.spread = 0.1;
  return particles;
}

/// Two of them: of 5 particles at t = 1, then of 3 at t = 2.
class TwoCheckpoints : public testing::Test {
 protected:
  TwoCheckpoints() {
    write_checkpoint(folder.path(), "hash", 1, 10, older, "first");
    write_checkpoint(folder.path(), "hash", 2, 20, newer, std::string("sec\0nd", 6));
  }
  std::optional<Checkpoint> read(const std::string& past = "hash") {
    refused.clear();
    return read_checkpoint(folder.path(), past, refused);
  }
  const ScratchFolder folder;
  const Particles older = some_particles(5, 0), newer = some_particles(3, 7);
  std::vector<std::string> refused;
};

TEST_F(TwoCheckpoints, TheNewerCountsWithAllItsBits) {
  const auto checkpoint = read();
  ASSERT_TRUE(checkpoint);
  EXPECT_EQ(checkpoint->facts.time, 2);
  EXPECT_EQ(checkpoint->facts.steps, 20u);
  EXPECT_EQ(checkpoint->state, std::string("sec\0nd", 6));
  EXPECT_EQ(checkpoint->facts.bytes, 8 * 3 * 6 + 6);
  expect_same(checkpoint->particles, newer);
  EXPECT_TRUE(refused.empty());
}

TEST_F(TwoCheckpoints, AThirdTakesThePlaceOfTheOlder) {
  write_checkpoint(folder.path(), "hash", 3, 30, some_particles(2, 1), "third");
  EXPECT_EQ(read()->facts.time, 3);
  fs::remove(folder / "state/0/manifest.json");
  EXPECT_EQ(read()->facts.time, 2);
}

const InHaste always = [] { return true; };

/// The system has the files, so it is whole when the process ends.
TEST_F(TwoCheckpoints, OneInHasteIsWhole) {
  write_checkpoint(folder.path(), "hash", 3, 30, some_particles(7, 1), "third", 1, always);
  EXPECT_FALSE(force_checkpoints(folder.path(), always));
  EXPECT_EQ(read()->facts.time, 3);
  expect_same(read()->particles, some_particles(7, 1));
  EXPECT_TRUE(force_checkpoints(folder.path()));
}

/// What a file system may have of it after a loss of power: a name with nothing behind it, or with zeros.
TEST_F(TwoCheckpoints, OneInHasteThatLostItsPowerIsRefusedAndTheOlderTaken) {
  write_checkpoint(folder.path(), "hash", 3, 30, some_particles(7, 1), "third", 1, always);
  for (const char* name : {"manifest.json", "particles_0000.raw", "run.raw"}) {
    const fs::path file = folder / "state/0" / name;
    const std::string whole = read_file(file);
    for (const std::string& left : {std::string(), std::string(whole.size(), '\0')}) {
      std::ofstream(file, std::ios::binary) << left;
      EXPECT_EQ(read()->facts.time, 2) << name;
      EXPECT_EQ(refused.size(), 1u);
    }
    std::ofstream(file, std::ios::binary) << whole;
    EXPECT_EQ(read()->facts.time, 3) << name;
  }
}

/// A stranger's folder may have a pipe or a link there; nobody waits for it.
TEST_F(TwoCheckpoints, OnlyFilesAreForcedToTheDisk) {
  fs::remove(folder / "state/0/run.raw");
  fs::create_symlink("nowhere", folder / "state/0/run.raw");
  ASSERT_EQ(mkfifo((folder / "state/0/particles_0001.raw").c_str(), 0600), 0);
  EXPECT_TRUE(force_checkpoints(folder.path()));
}

TEST(LargeCheckpoint, HasTheSameFilesFromAnyNumberOfThreads) {
  const ScratchFolder one, two;
  Particles particles;
  constexpr std::size_t count = (std::size_t{1} << 20) + 5;  // in two pieces
  particles.dimension = 1;
  for (std::size_t j = 0; j < count; ++j) particles.position[0].push_back(static_cast<double>(j));
  particles.alpha.assign(count, 0.5);
  particles.id.assign(count, 1);
  write_checkpoint(one.path(), "hash", 1, 10, particles, "");
  write_checkpoint(two.path(), "hash", 1, 10, particles, "", 2);
  for (const char* name : {"manifest.json", "particles_0000.raw", "particles_0001.raw", "run.raw"})
    EXPECT_TRUE(read_file(one / "state/0" / name) == read_file(two / "state/0" / name)) << name;
  std::vector<std::string> refused;
  expect_same(read_checkpoint(two.path(), "hash", refused)->particles, particles);
}

TEST_F(TwoCheckpoints, WhatIsDamagedIsRefusedAndTheOlderTaken) {
  for (const char* file : {"state/1/particles_0000.raw", "state/1/run.raw"}) {
    const std::string whole = read_file(folder / file);
    for (std::size_t at = 0; at < whole.size(); ++at) {
      std::string damaged = whole;
      damaged[at] = static_cast<char>(damaged[at] ^ 1);
      std::ofstream(folder / file, std::ios::binary) << damaged;
      const auto checkpoint = read();
      ASSERT_TRUE(checkpoint);
      ASSERT_EQ(checkpoint->facts.time, 1) << file << " byte " << at;
      expect_same(checkpoint->particles, older);
      ASSERT_EQ(refused.size(), 1u);
      ASSERT_NE(refused[0].find("check sum"), std::string::npos) << refused[0];
    }
    std::ofstream(folder / file, std::ios::binary) << whole.substr(1);
    EXPECT_EQ(read()->facts.time, 1);
    EXPECT_NE(refused[0].find("bytes, must have"), std::string::npos) << refused[0];
    fs::remove(folder / file);
    EXPECT_EQ(read()->facts.time, 1);
    EXPECT_NE(refused[0].find("is missing"), std::string::npos) << refused[0];
    std::ofstream(folder / file, std::ios::binary) << whole;
    EXPECT_EQ(read()->facts.time, 2);
  }
}

TEST_F(TwoCheckpoints, AManifestWithAnyOneByteWrongIsNeverACrash) {
  const fs::path file = folder / "state/1/manifest.json";
  const std::string whole = read_file(file);
  for (std::size_t at = 0; at < whole.size(); ++at)
    for (const char wrong : {'9', '}', '\0'}) {
      std::string damaged = whole;
      damaged[at] = wrong;
      std::ofstream(file, std::ios::binary) << damaged;
      const auto checkpoint = read();
      ASSERT_TRUE(checkpoint) << at << wrong;
      const bool space = whole[at] == ' ' || whole[at] == '\n';
      if (damaged != whole && !space) {
        EXPECT_EQ(checkpoint->facts.time, 1) << at << wrong;
      }
    }
  for (std::size_t length = 0; length < whole.size(); ++length) {
    std::ofstream(file, std::ios::binary) << whole.substr(0, length);
    const auto checkpoint = read();
    ASSERT_TRUE(checkpoint);
    if (length + 1 < whole.size()) {
      EXPECT_EQ(checkpoint->facts.time, 1) << length;
    }
  }
}

TEST_F(TwoCheckpoints, AnotherCaseAndANewerFormatAreRefusedByTheirReason) {
  EXPECT_FALSE(read("other"));
  ASSERT_EQ(refused.size(), 2u);
  EXPECT_NE(refused[0].find("a case with other settings or data"), std::string::npos) << refused[0];
  const fs::path file = folder / "state/1/manifest.json";
  std::string text = read_file(file);
  text.replace(text.find("\"version\": 1"), 12, "\"version\": 2");
  std::ofstream(file, std::ios::binary) << text;
  EXPECT_EQ(read()->facts.time, 1);
  EXPECT_NE(refused[0].find("newer gaussdrift"), std::string::npos) << refused[0];
}

/// By somebody who knows the check sum.
void write_manifest(const fs::path& file, nlohmann::ordered_json manifest) {
  manifest.erase("crc32");
  const std::string rest = manifest.dump();
  manifest["crc32"] = crc32_z(0, reinterpret_cast<const Bytef*>(rest.data()), rest.size());
  std::ofstream(file, std::ios::binary) << manifest.dump(2);
}

TEST_F(TwoCheckpoints, ACraftedManifestIsRefusedByItsReason) {
  using json = nlohmann::ordered_json;
  const fs::path file = folder / "state/1/manifest.json";
  const json honest = json::parse(read_file(file));
  const json piece = honest["pieces"][0];
  const std::vector<std::tuple<const char*, json, const char*>> crafted = {
      {"/state/file", "../0/run.raw", "its manifest names a file elsewhere"},
      {"/state/file", std::string("run.raw\0", 8), "its manifest names a file elsewhere"},
      {"/state/file", "", " is missing"},
      {"/particles", -3, "particles is no count"},
      {"/particles", 1e300, "particles is no count"},
      {"/steps", 1.5, "steps is no count"},
      {"/serial", "2", "serial is no count"},
      {"/dimension", 4, "its dimension is wrong"},
      {"/time", nullptr, "time is no number"},
      {"/case", json::array(), "case is no text"},
      {"/columns", json::object(), "columns is no list"},
      {"/pieces", {piece, piece}, "its pieces are wrong"},
      {"/pieces/0/particles", std::uint64_t{1} << 63, "its pieces are wrong"},
      {"/spread", "nan", "spread is no width"},
      {"/version", -1, "version is no count"}};
  for (const auto& [place, value, why] : crafted) {
    json manifest = honest;
    manifest[json::json_pointer(place)] = value;
    write_manifest(file, std::move(manifest));
    EXPECT_EQ(read()->facts.time, 1) << place;
    ASSERT_EQ(refused.size(), 1u) << place;
    EXPECT_NE(refused[0].find(why), std::string::npos) << refused[0];
  }
}

// Its check sum is that of the text as it is written again, which must not take a stack without bound.
TEST_F(TwoCheckpoints, AManifestThatIsNestedDeeplyIsRefused) {
  std::string text = read_file(folder / "state/1/manifest.json");
  const std::string deep(400'000, '['), closed(400'000, ']');
  text.insert(1, "\"more\": " + deep + closed + ",");
  std::ofstream(folder / "state/1/manifest.json", std::ios::binary) << text;
  EXPECT_EQ(read()->facts.time, 1);
  EXPECT_NE(refused[0].find("nested more than 50 deep"), std::string::npos) << refused[0];
}

TEST(Checkpoint, WhereThereIsNoneNothingIsRefused) {
  const ScratchFolder folder;
  std::vector<std::string> refused;
  EXPECT_FALSE(read_checkpoint(folder.path(), "hash", refused));
  EXPECT_TRUE(refused.empty());
}

TEST(Checkpoint, AFullDiskLeavesTheOneBefore) {
  const ScratchFolder folder;
  write_checkpoint(folder.path(), "hash", 1, 10, some_particles(5, 0), "first");
  {
    const FileSizeLimit limit(100);
    EXPECT_THROW(write_checkpoint(folder.path(), "hash", 2, 20, some_particles(500, 0), "second"), FileError);
  }
  std::vector<std::string> refused;
  EXPECT_EQ(read_checkpoint(folder.path(), "hash", refused)->facts.time, 1);
}

}  // namespace
}  // namespace gaussdrift::write
