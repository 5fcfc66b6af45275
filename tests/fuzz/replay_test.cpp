// The corpus of each target, as it is and with small changes: every input is answered, and takes little memory.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <iterator>
#include <new>
#include <random>

#include "fuzz_target.hpp"

namespace {

// Bytes that live, and the most that lived. The size of a block stands before it.
std::atomic<std::size_t> living{0}, most_living{0};
constexpr std::size_t header = 64;

void* counted(std::size_t size, std::size_t alignment) {
  if (size > std::size_t{1} << 40) throw std::bad_alloc();
  void* block = std::aligned_alloc(header, (size + header + header - 1) / header * header);
  if (!block || alignment > header) throw std::bad_alloc();
  *static_cast<std::size_t*>(block) = size;
  const std::size_t now = living += size;
  std::size_t most = most_living;
  while (now > most && !most_living.compare_exchange_weak(most, now)) {
  }
  return static_cast<char*>(block) + header;
}

void uncounted(void* pointer) {
  if (!pointer) return;
  void* block = static_cast<char*>(pointer) - header;
  living -= *static_cast<std::size_t*>(block);
  std::free(block);
}

}  // namespace

void* operator new(std::size_t size) { return counted(size, 1); }
void* operator new[](std::size_t size) { return counted(size, 1); }
void* operator new(std::size_t size, std::align_val_t alignment) {
  return counted(size, static_cast<std::size_t>(alignment));
}
void* operator new[](std::size_t size, std::align_val_t alignment) {
  return counted(size, static_cast<std::size_t>(alignment));
}
void operator delete(void* pointer) noexcept { uncounted(pointer); }
void operator delete[](void* pointer) noexcept { uncounted(pointer); }
void operator delete(void* pointer, std::size_t) noexcept { uncounted(pointer); }
void operator delete[](void* pointer, std::size_t) noexcept { uncounted(pointer); }
void operator delete(void* pointer, std::align_val_t) noexcept { uncounted(pointer); }
void operator delete[](void* pointer, std::align_val_t) noexcept { uncounted(pointer); }
void operator delete(void* pointer, std::size_t, std::align_val_t) noexcept { uncounted(pointer); }
void operator delete[](void* pointer, std::size_t, std::align_val_t) noexcept { uncounted(pointer); }

namespace gaussdrift::fuzz {
namespace {

namespace fs = std::filesystem;

/// Changes as libFuzzer makes them, the same on every machine.
class Mutator {
 public:
  explicit Mutator(std::vector<std::string> words) : words_(std::move(words)) {}

  std::string changed(std::string text) {
    for (std::size_t changes = 1 + below(3); changes > 0; --changes) {
      const std::size_t at = below(text.size() + 1), length = std::size_t{1} << below(8);
      switch (below(6)) {
        case 0:
          if (at < text.size()) text[at] = static_cast<char>(below(256));
          break;
        case 1:
          if (at < text.size()) text[at] = static_cast<char>(text[at] ^ (1 << below(8)));
          break;
        case 2:
          text.erase(at, length);
          break;
        case 3:
          text.insert(at, text.substr(at, length));
          break;
        case 4:
          text.insert(at, words_[below(words_.size())]);
          break;
        default:
          text.replace(at, std::min(length, text.size() - at), words_[below(words_.size())]);
      }
    }
    return text;
  }

 private:
  std::size_t below(std::size_t n) { return random_() % n; }

  std::mt19937_64 random_{1};
  std::vector<std::string> words_;
};

std::string content(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// The words of a dictionary: those between the quotation marks of each line.
std::vector<std::string> words_of(const fs::path& dictionary) {
  std::vector<std::string> words{"0", "-1", "1e999", "nan", "99999999999999999999", "2147483647", "\"", "\n", "\\"};
  std::ifstream stream(dictionary);
  for (std::string line; std::getline(stream, line);)
    if (const std::size_t first = line.find('"'), last = line.rfind('"'); first < last)
      words.push_back(line.substr(first + 1, last - first - 1));
  return words;
}

/// What verbs of the program say goes nowhere while this lives.
class Silence {
 public:
  Silence() {
    std::fflush(nullptr);
    const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
    for (const int stream : {STDOUT_FILENO, STDERR_FILENO}) {
      kept_[stream - 1] = dup(stream);
      dup2(nowhere, stream);
    }
    close(nowhere);
  }
  ~Silence() {
    std::fflush(nullptr);
    for (const int stream : {STDOUT_FILENO, STDERR_FILENO}) {
      dup2(kept_[stream - 1], stream);
      close(kept_[stream - 1]);
    }
  }
  Silence(const Silence&) = delete;
  Silence& operator=(const Silence&) = delete;

 private:
  int kept_[2] = {-1, -1};
};

/// The message of what is thrown; empty if nothing is.
std::string thrown_by(const Target& target, const std::string& text) {
  const Silence silence;
  try {
    target.run(text);
  } catch (const std::exception& error) {
    return std::string("throws ") + error.what();
  }
  return "";
}

class EveryTarget : public ::testing::TestWithParam<Target> {
 protected:
  static void run(const std::string& text, const std::string& of) {
    const std::size_t before = living;
    most_living = before;
    ASSERT_EQ(thrown_by(GetParam(), text), "") << of << ":\n" << text;
    // Whatever its size: blocks in which files are read, messages, tables that are made once. A run that goes on from a
    // checkpoint also needs up to a million boxes of 8 bytes to bound the error of its density.
    const std::size_t at_least = std::size_t{1} << (std::string_view(GetParam().name) == "checkpoint" ? 24 : 21);
    EXPECT_LT(most_living - before, at_least + 50 * text.size()) << of << ":\n" << text;
  }
};

TEST_P(EveryTarget, AnswersItsCorpusAndWhatIsLikeIt) {
  const fs::path folder = fs::path(CORPUS) / "corpus" / GetParam().name;
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder)) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  ASSERT_FALSE(files.empty()) << folder;
  Mutator mutator(words_of(fs::path(CORPUS) / (std::string(GetParam().name) + ".dict")));
  run("", "nothing");
  for (const fs::path& file : files) {
    const std::string text = content(file);
    run(text, file);
    for (int k = 0; k < 40; ++k) run(mutator.changed(text), file);
  }
}

INSTANTIATE_TEST_SUITE_P(Fuzz, EveryTarget, ::testing::ValuesIn(targets()),
                         [](const auto& about) { return std::string(about.param.name); });

TEST(Corpus, HasAFolderForEachTargetAndNoOther) {
  std::vector<std::string> names, folders;
  for (const Target& target : targets()) names.emplace_back(target.name);
  for (const auto& entry : fs::directory_iterator(fs::path(CORPUS) / "corpus"))
    folders.push_back(entry.path().filename());
  std::sort(names.begin(), names.end());
  std::sort(folders.begin(), folders.end());
  EXPECT_EQ(names, folders);
}

}  // namespace
}  // namespace gaussdrift::fuzz
