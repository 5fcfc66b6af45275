// Work that another thread does meanwhile, one piece at a time.
#pragma once

#include <exception>
#include <functional>
#include <thread>
#include <utility>

namespace gaussdrift::render {

class Beside {
 public:
  Beside() = default;
  Beside(const Beside&) = delete;
  Beside& operator=(const Beside&) = delete;
  ~Beside() {
    if (thread_.joinable()) thread_.join();
  }

  /// After the piece before has ended. Throws what that has thrown.
  void begin(std::function<void()> work) {
    wait();
    thread_ = std::thread([this, work = std::move(work)] {
      try {
        work();
      } catch (...) {
        failure_ = std::current_exception();
      }
    });
  }

  /// Until it has ended. Throws what it has thrown, once.
  void wait() {
    if (thread_.joinable()) thread_.join();
    if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
  }

 private:
  std::thread thread_;
  std::exception_ptr failure_;
};

}  // namespace gaussdrift::render
