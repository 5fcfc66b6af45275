// Preloaded into the program (LD_PRELOAD): lets its k-th call that writes a file fail, or kills it there, or lets its k-th
// allocation fail. The environment says what is to happen:
//   FAULTS_FOLDER   calls on files in it, at any depth, are counted
//   FAULTS_AT       which call fails, from 1
//   FAULTS_ERROR    with which errno; "kill": the process is killed there by SIGKILL; "term": it gets SIGTERM there, and
//                   the call is done
//   FAULTS_LASTING  set: all later calls fail too, but those that close or remove, as on a disk that takes nothing more;
//                   "room": only those that need room do, as on a disk that stays full. A later signal comes at each call
//   FAULTS_LOG      file that takes a line for each write, fsync, rename, removal and new folder: "<call> <inode> <file>".
//                   A new name has the inode of the file that gets it, a new folder 0. Before a rename comes a line
//                   "leave" with the old name
//   FAULTS_NEW_AT   which allocation of the program itself fails, from 1 after the first call that is counted
//   FAULTS_NEW_ALL  set: allocations are counted from the start of the program
//   FAULTS_NEW_OF   "libraries": all allocations by operator new count, those in libraries as well, and those of the
//                   program by malloc() and the like (Eigen)
//   FAULTS_NEW_LASTING  set: all later allocations fail too. Then those of libraries by malloc() count as well
//   FAULTS_REPORT   file that takes "struck <call> <file>" at the fault and "calls <n> allocations <n> bytes <n>"
//                   at the exit, with the bytes that were written
//   FAULTS_SERVE    set: the program does not begin. It reads lines of three parts from standard input, parted by tabs: a
//                   folder, variables, arguments. For each it begins in a new process there, and then writes how that
//                   ended, as the shell tells it, to standard output. The value is a library that the program may load: it is there
//                   from the beginning, because to load VTK and Mesa takes longer than a small run.
// A write that fails has written its first half. fsync is counted and not done: a killed process loses nothing of what the
// system has, and the test takes a third of the time.
#include <dlfcn.h>
#include <fcntl.h>
#include <link.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>
#include <wordexp.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>

namespace {

template <class Function>
Function* next(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

long number_of(const char* variable) {
  const char* text = std::getenv(variable);
  return text ? std::atol(text) : 0;
}

struct Plan {
  Plan() {
    if (const char* text = std::getenv("FAULTS_FOLDER")) folder = text;
    if (const char* text = std::getenv("FAULTS_ERROR"))
      signal = std::strcmp(text, "kill") == 0 ? SIGKILL : std::strcmp(text, "term") == 0 ? SIGTERM : 0;
    report = std::getenv("FAULTS_REPORT");
    at = number_of("FAULTS_AT"), error = static_cast<int>(number_of("FAULTS_ERROR"));
    if (const char* text = std::getenv("FAULTS_LASTING")) lasting = true, room = std::strcmp(text, "room") == 0;
    log = std::getenv("FAULTS_LOG");
    new_at = number_of("FAULTS_NEW_AT"), new_all = std::getenv("FAULTS_NEW_ALL") != nullptr;
    new_of_libraries = std::getenv("FAULTS_NEW_OF") != nullptr;
    new_lasting = std::getenv("FAULTS_NEW_LASTING") != nullptr;
  }
  const char* folder = nullptr;
  const char* report = nullptr;
  const char* log = nullptr;
  long at = 0, new_at = 0;
  int error = 0, signal = 0;
  bool lasting = false, room = false, new_all = false, new_of_libraries = false, new_lasting = false;
};

Plan& plan() {
  static Plan the_plan;
  return the_plan;
}

std::atomic<long> calls{0}, allocations{0}, bytes{0};

/// Without stdio and without operator new, which are counted.
void add_line(const char* file, const char* line) {
  static const auto open_it = next<int(const char*, int, ...)>("open");
  static const auto write_it = next<ssize_t(int, const void*, size_t)>("write");
  static const auto close_it = next<int(int)>("close");
  if (!file) return;
  const int descriptor = open_it(file, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (descriptor < 0) return;
  if (write_it(descriptor, line, std::strlen(line)) < 0) std::abort();
  close_it(descriptor);
}

void report(const char* line) { add_line(plan().report, line); }

void log(const char* call, unsigned long inode, const char* file) {
  char line[4200];
  std::snprintf(line, sizeof line, "%s %lu %s\n", call, inode, file);
  add_line(plan().log, line);
}

bool is_counted(const char* path) {
  if (!plan().folder) return false;
  char absolute[8192];
  if (path[0] != '/') {
    if (!getcwd(absolute, sizeof absolute / 2)) return false;
    const size_t length = std::strlen(absolute);
    std::snprintf(absolute + length, sizeof absolute - length, "/%s", path);
    path = absolute;
  }
  const size_t length = std::strlen(plan().folder);
  return std::strncmp(path, plan().folder, length) == 0 && (path[length] == '/' || path[length] == 0);
}

/// The name of an open file; "" if it has none.
struct NameOf {
  explicit NameOf(int descriptor) {
    char link[64];
    std::snprintf(link, sizeof link, "/proc/self/fd/%d", descriptor);
    const ssize_t length = readlink(link, name, sizeof name - 1);
    name[std::max<ssize_t>(length, 0)] = 0;
  }
  char name[4096];
};

void log_open(const char* call, int descriptor) {
  struct stat facts {};
  const NameOf file(descriptor);
  if (plan().log && is_counted(file.name) && ::fstat(descriptor, &facts) == 0) log(call, facts.st_ino, file.name);
}

void log_name(const char* call, const char* from, const char* to) {
  struct stat facts {};
  if (plan().log && is_counted(to)) log(call, ::lstat(from, &facts) == 0 ? facts.st_ino : 0, to);
}

/// `stays`: needs no room that the file has not already.
enum class Kind { writes, stays, closes };

/// Of bytes that are written at a place of a file.
Kind kind_of(int descriptor, off_t end) {
  struct stat facts {};
  return ::fstat(descriptor, &facts) == 0 && end <= facts.st_size ? Kind::stays : Kind::writes;
}

/// Counts a call. True: this one is to fail, after `half` of its work. It does not return where the process is to die.
template <class Half>
bool strikes(const char* call, const char* path, Kind kind, const Half& half) {
  const int before = errno;
  if (!is_counted(path)) return errno = before, false;
  const long number = ++calls;
  const bool first = number == plan().at;
  const bool fails_later = plan().signal || kind == Kind::writes || (kind == Kind::stays && !plan().room);
  const bool later = plan().lasting && plan().at > 0 && number > plan().at && fails_later;
  if (!first && !later) return errno = before, false;
  if (plan().signal != SIGTERM) half();
  if (first) {
    char line[4200];
    std::snprintf(line, sizeof line, "struck %s %s\n", call, path);
    report(line);
  }
  if (plan().signal) ::kill(getpid(), plan().signal);
  errno = plan().signal ? before : plan().error;
  return !plan().signal;
}

bool strikes(const char* call, const char* path, Kind kind = Kind::writes) {
  return strikes(call, path, kind, [] {});
}

/// What went into a file, if it is counted.
ssize_t wrote(const char* path, ssize_t size) {
  const int before = errno;
  if (size > 0 && is_counted(path)) bytes += size;
  return errno = before, size;
}

bool opens_to_write(int flags) { return (flags & O_CREAT) || (flags & O_ACCMODE) != O_RDONLY; }

mode_t mode_in(int flags, va_list arguments) { return (flags & O_CREAT) ? va_arg(arguments, mode_t) : 0; }

/// Where the program itself lies in memory, without its libraries: the first object that the loader tells of.
struct OwnCode {
  OwnCode() {
    dl_iterate_phdr(
        [](dl_phdr_info* object, size_t, void* result) {
          auto& own = *static_cast<OwnCode*>(result);
          for (int i = 0; i < object->dlpi_phnum; ++i) {
            if (object->dlpi_phdr[i].p_type != PT_LOAD) continue;
            const std::uintptr_t begin = object->dlpi_addr + object->dlpi_phdr[i].p_vaddr;
            own.first = std::min(own.first, begin);
            own.last = std::max(own.last, begin + object->dlpi_phdr[i].p_memsz);
          }
          return 1;
        },
        this);
  }
  std::uintptr_t first = UINTPTR_MAX, last = 0;
};

bool is_in_program(void* caller) {
  static const OwnCode own;
  const auto at = reinterpret_cast<std::uintptr_t>(caller);
  return own.first <= at && at < own.last;
}

/// Counts an allocation. True: this one is to fail. What it needs itself is not counted.
bool lacks_memory(const char* call, bool by_new, void* caller) {
  if (!plan().new_all && calls == 0) return false;
  const bool counts =
      plan().new_of_libraries ? by_new || plan().new_lasting || is_in_program(caller) : by_new && is_in_program(caller);
  if (!counts) return false;
  static std::atomic<bool> telling{false};
  if (telling) return false;
  const long number = ++allocations;
  const bool first = number == plan().new_at, later = plan().new_lasting && plan().new_at > 0 && number > plan().new_at;
  if (first) {
    telling = true;
    Dl_info place{};
    dladdr(caller, &place);
    char line[300];
    std::snprintf(line, sizeof line, "struck %s at +0x%zx in %.200s\n", call,
                  reinterpret_cast<size_t>(caller) - reinterpret_cast<size_t>(place.dli_fbase),
                  place.dli_fname ? place.dli_fname : "?");
    report(line);
    telling = false;
  }
  if (first || later) errno = ENOMEM;
  return first || later;
}

// Of glibc; the usual names are those of this library.
extern "C" void* __libc_malloc(size_t);
extern "C" void* __libc_calloc(size_t, size_t);
extern "C" void* __libc_realloc(void*, size_t);
extern "C" void* __libc_memalign(size_t, size_t);

void* allocate(size_t size, size_t alignment, void* caller) {
  if (lacks_memory("new", true, caller)) throw std::bad_alloc();
  size = std::max<size_t>(size, 1);
  void* memory = alignment ? __libc_memalign(alignment, size) : __libc_malloc(size);
  if (!memory) throw std::bad_alloc();
  return memory;
}

/// An allocation in the manner of C.
template <class Allocate>
void* allocate_or_null(const char* call, void* caller, const Allocate& do_it) {
  return lacks_memory(call, false, caller) ? nullptr : do_it();
}

int (*program)(int, char**, char**) = nullptr;  // its main

/// What `text` has before the next tab or the end, which is cut off.
char* part_of(char*& text) {
  char* part = text;
  text += std::strcspn(text, "\t\n");
  if (*text) *text++ = '\0';
  return part;
}

/// Into a file of that folder.
void redirect(int descriptor, const char* file) {
  const int opened = ::open(file, descriptor == 0 ? O_RDONLY : O_WRONLY | O_CREAT | O_TRUNC, 0666);
  if (opened < 0 || dup2(opened, descriptor) < 0) _exit(99);
  ::close(opened);
}

[[noreturn]] void begin(char* request) {
  if (chdir(part_of(request)) != 0) _exit(99);
  redirect(0, "/dev/null"), redirect(1, "stdout.txt"), redirect(2, "stderr.txt");
  wordexp_t words{}, arguments{};
  if (wordexp(part_of(request), &words, WRDE_NOCMD) != 0 || wordexp(part_of(request), &arguments, WRDE_NOCMD) != 0)
    _exit(99);
  for (size_t i = 0; i < words.we_wordc; ++i) putenv(words.we_wordv[i]);
  unsetenv("FAULTS_SERVE");
  plan() = Plan();
  calls = 0, allocations = 0, bytes = 0;
  std::exit(program(static_cast<int>(arguments.we_wordc), arguments.we_wordv, environ));
}

int serve(int argc, char** argv, char** environment) {
  const char* library = std::getenv("FAULTS_SERVE");
  if (!library) return program(argc, argv, environment);
  dlopen(library, RTLD_LAZY | RTLD_LOCAL);  // a program without pictures has none
  static char request[20'000];
  while (std::fgets(request, sizeof request, stdin)) {
    const pid_t child = fork();
    if (child == 0) begin(request);
    int status = 0;
    waitpid(child, &status, 0);
    std::printf("%d\n", WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status));
    std::fflush(stdout);
  }
  _exit(0);
}

[[gnu::destructor]] void tell_counts() {
  char line[150];
  std::snprintf(line, sizeof line, "calls %ld allocations %ld bytes %ld\n", calls.load(), allocations.load(),
                bytes.load());
  report(line);
}

}  // namespace

extern "C" int __libc_start_main(int (*main)(int, char**, char**), int argc, char** argv, void (*init)(), void (*end)(),
                                 void (*end_of_loader)(), void* stack) {
  program = main;
  static const auto real =
      next<int(int (*)(int, char**, char**), int, char**, void (*)(), void (*)(), void (*)(), void*)>(
          "__libc_start_main");
  return real(serve, argc, argv, init, end, end_of_loader, stack);
}

void* operator new(size_t size) { return allocate(size, 0, __builtin_return_address(0)); }
void* operator new[](size_t size) { return allocate(size, 0, __builtin_return_address(0)); }
void* operator new(size_t size, std::align_val_t alignment) {
  return allocate(size, static_cast<size_t>(alignment), __builtin_return_address(0));
}
void* operator new[](size_t size, std::align_val_t alignment) {
  return allocate(size, static_cast<size_t>(alignment), __builtin_return_address(0));
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete[](void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, size_t) noexcept { std::free(memory); }
void operator delete[](void* memory, size_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete[](void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, size_t, std::align_val_t) noexcept { std::free(memory); }
void operator delete[](void* memory, size_t, std::align_val_t) noexcept { std::free(memory); }

extern "C" {

void* malloc(size_t size) {
  return allocate_or_null("malloc", __builtin_return_address(0), [&] { return __libc_malloc(size); });
}
void* calloc(size_t count, size_t size) {
  return allocate_or_null("calloc", __builtin_return_address(0), [&] { return __libc_calloc(count, size); });
}
void* realloc(void* memory, size_t size) {
  return allocate_or_null("realloc", __builtin_return_address(0), [&] { return __libc_realloc(memory, size); });
}
void* aligned_alloc(size_t alignment, size_t size) {
  return allocate_or_null("aligned_alloc", __builtin_return_address(0),
                          [&] { return __libc_memalign(alignment, size); });
}
int posix_memalign(void** memory, size_t alignment, size_t size) {
  *memory =
      allocate_or_null("posix_memalign", __builtin_return_address(0), [&] { return __libc_memalign(alignment, size); });
  return *memory ? 0 : ENOMEM;
}

#define OPENS(name)                                                   \
  int name(const char* path, int flags, ...) {                        \
    static const auto real = next<int(const char*, int, ...)>(#name); \
    va_list arguments;                                                \
    va_start(arguments, flags);                                       \
    const mode_t mode = mode_in(flags, arguments);                    \
    va_end(arguments);                                                \
    if (opens_to_write(flags) && strikes(#name, path)) return -1;     \
    return real(path, flags, mode);                                   \
  }
OPENS(open)
OPENS(open64)

#define OPENS_AT(name)                                                     \
  int name(int folder, const char* path, int flags, ...) {                 \
    static const auto real = next<int(int, const char*, int, ...)>(#name); \
    va_list arguments;                                                     \
    va_start(arguments, flags);                                            \
    const mode_t mode = mode_in(flags, arguments);                         \
    va_end(arguments);                                                     \
    if (opens_to_write(flags) && strikes(#name, path)) return -1;          \
    return real(folder, path, flags, mode);                                \
  }
OPENS_AT(openat)
OPENS_AT(openat64)

#define OPENS_STREAM(name)                                                      \
  std::FILE* name(const char* path, const char* mode) {                         \
    static const auto real = next<std::FILE*(const char*, const char*)>(#name); \
    if (std::strpbrk(mode, "wa+") && strikes(#name, path)) return nullptr;      \
    return real(path, mode);                                                    \
  }
OPENS_STREAM(fopen)
OPENS_STREAM(fopen64)

std::FILE* fdopen(int descriptor, const char* mode) noexcept {
  static const auto real = next<std::FILE*(int, const char*)>("fdopen");
  if (std::strpbrk(mode, "wa+") && strikes("fdopen", NameOf(descriptor).name)) return nullptr;
  return real(descriptor, mode);
}

ssize_t write(int descriptor, const void* data, size_t size) {
  static const auto real = next<ssize_t(int, const void*, size_t)>("write");
  const auto half = [&] { (void)!real(descriptor, data, size / 2); };
  const Kind kind = kind_of(descriptor, ::lseek(descriptor, 0, SEEK_CUR) + static_cast<off_t>(size));
  log_open("write", descriptor);
  if (strikes("write", NameOf(descriptor).name, kind, half)) return -1;
  return wrote(NameOf(descriptor).name, real(descriptor, data, size));
}

ssize_t pwrite(int descriptor, const void* data, size_t size, off_t place) {
  static const auto real = next<ssize_t(int, const void*, size_t, off_t)>("pwrite");
  const auto half = [&] { (void)!real(descriptor, data, size / 2, place); };
  const Kind kind = kind_of(descriptor, place + static_cast<off_t>(size));
  log_open("pwrite", descriptor);
  if (strikes("pwrite", NameOf(descriptor).name, kind, half)) return -1;
  return wrote(NameOf(descriptor).name, real(descriptor, data, size, place));
}

size_t fwrite(const void* data, size_t size, size_t count, std::FILE* stream) {
  static const auto real = next<size_t(const void*, size_t, size_t, std::FILE*)>("fwrite");
  static const auto flush = next<int(std::FILE*)>("fflush");
  const auto half = [&] {
    real(data, 1, size * count / 2, stream);
    flush(stream);
  };
  const Kind kind = kind_of(fileno(stream), std::ftell(stream) + static_cast<off_t>(size * count));
  log_open("fwrite", fileno(stream));
  if (strikes("fwrite", NameOf(fileno(stream)).name, kind, half)) return count / 2;
  const size_t written = real(data, size, count, stream);
  wrote(NameOf(fileno(stream)).name, static_cast<ssize_t>(written * size));
  return written;
}

int fflush(std::FILE* stream) {
  static const auto real = next<int(std::FILE*)>("fflush");
  if (stream && strikes("fflush", NameOf(fileno(stream)).name, Kind::stays)) return EOF;
  return real(stream);
}

int fclose(std::FILE* stream) {
  static const auto real = next<int(std::FILE*)>("fclose");
  const bool fails = strikes("fclose", NameOf(fileno(stream)).name, Kind::closes);
  const int problem = errno, result = real(stream);
  return fails ? (errno = problem, EOF) : result;
}

int close(int descriptor) {
  static const auto real = next<int(int)>("close");
  const bool fails = strikes("close", NameOf(descriptor).name, Kind::closes);
  const int problem = errno, result = real(descriptor);
  return fails ? (errno = problem, -1) : result;
}

int fsync(int descriptor) {
  static const auto real = next<int(int)>("fsync");
  const NameOf file(descriptor);
  log_open("fsync", descriptor);
  if (strikes("fsync", file.name, Kind::stays)) return -1;
  return is_counted(file.name) ? 0 : real(descriptor);
}

int rename(const char* from, const char* to) noexcept {
  static const auto real = next<int(const char*, const char*)>("rename");
  log_name("leave", from, from);
  log_name("rename", from, to);
  return strikes("rename", to, Kind::stays) ? -1 : real(from, to);
}

int link(const char* from, const char* to) noexcept {
  static const auto real = next<int(const char*, const char*)>("link");
  return strikes("link", to) ? -1 : real(from, to);
}

int linkat(int a, const char* from, int b, const char* to, int flags) noexcept {
  static const auto real = next<int(int, const char*, int, const char*, int)>("linkat");
  return strikes("linkat", to) ? -1 : real(a, from, b, to, flags);
}

int mkdir(const char* path, mode_t mode) noexcept {
  static const auto real = next<int(const char*, mode_t)>("mkdir");
  log_name("mkdir", path, path);
  return strikes("mkdir", path) ? -1 : real(path, mode);
}

#define REMOVES(name)                                            \
  int name(const char* path) noexcept {                          \
    static const auto real = next<int(const char*)>(#name);      \
    log_name("remove", path, path);                              \
    return strikes(#name, path, Kind::closes) ? -1 : real(path); \
  }
REMOVES(unlink)
REMOVES(remove)

int ftruncate(int descriptor, off_t length) noexcept {
  static const auto real = next<int(int, off_t)>("ftruncate");
  log_open("ftruncate", descriptor);
  return strikes("ftruncate", NameOf(descriptor).name) ? -1 : real(descriptor, length);
}

}  // extern "C"
