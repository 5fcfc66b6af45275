#include "sim/shared_reference.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "base/state_bytes.hpp"

namespace gaussdrift {

namespace {

void pass(base::StateBytes& bytes, ReferenceReport& report) {
  bytes(report.untraced, report.first_untraced, report.trouble, report.rates, report.exhausted);
}

// The last axis counts first, as in the order of grid points.
bool is_before(const Vector& a, const Vector& b) {
  return std::lexicographical_compare(a.rbegin(), a.rend(), b.rbegin(), b.rend());
}

class SharedReference : public Reference {
 public:
  SharedReference(std::unique_ptr<Reference> own, const Lattice& lattice, base::Communicator& ranks)
      : own_(std::move(own)), points_(lattice.size()), ranks_(ranks) {}

  std::size_t together() const override { return own_->together(); }
  void pass(const std::vector<double>& times) override { own_->pass(times); }

  ReferenceReport evaluate(double time, std::vector<double>& rho) override {
    ReferenceReport report;
    ranks_.agree_on([&] { report = own_->evaluate(time, rho); });
    std::vector<double> values;
    each_block(points_, own_rank(), [&](std::size_t first, std::size_t end) {
      values.insert(values.end(), rho.begin() + static_cast<std::ptrdiff_t>(first),
                    rho.begin() + static_cast<std::ptrdiff_t>(end));
    });
    collect(values, points_, rho);
    return of_all(report);
  }

  ReferenceReport evaluate_at(double time, const std::vector<std::size_t>& points,
                              std::vector<double>& rho) const override {
    base::Bytes bytes = base::to_bytes(points);
    ranks_.broadcast(bytes);
    const auto told = base::from_bytes<std::size_t>(bytes);
    std::vector<std::size_t> some;
    each_block(told.size(), own_rank(), [&](std::size_t first, std::size_t end) {
      some.insert(some.end(), told.begin() + static_cast<std::ptrdiff_t>(first),
                  told.begin() + static_cast<std::ptrdiff_t>(end));
    });
    ReferenceReport report;
    std::vector<double> values;
    ranks_.agree_on([&] { report = own_->evaluate_at(time, some, values); });
    rho.assign(told.size(), 0.0);
    collect(values, told.size(), rho);
    return of_all(report);
  }

 private:
  std::size_t own_rank() const { return static_cast<std::size_t>(ranks_.rank()); }

  // use(first, end) for every block of that rank.
  template <class Use>
  void each_block(std::size_t count, std::size_t rank, const Use& use) const {
    const std::size_t length = together(), step = static_cast<std::size_t>(ranks_.size()) * length;
    for (std::size_t first = rank * length; first < count; first += step) use(first, std::min(count, first + length));
  }

  // The values of all ranks, on rank 0.
  void collect(const std::vector<double>& own, std::size_t count, std::vector<double>& rho) const {
    const std::vector<base::Bytes> of_ranks = ranks_.gather(base::to_bytes(own));
    for (std::size_t rank = 0; rank < of_ranks.size(); ++rank) {
      const auto values = base::from_bytes<double>(of_ranks[rank]);
      auto from = values.begin();
      each_block(count, rank, [&](std::size_t first, std::size_t end) {
        std::copy_n(from, end - first, rho.begin() + static_cast<std::ptrdiff_t>(first));
        from += static_cast<std::ptrdiff_t>(end - first);
      });
    }
  }

  ReferenceReport of_all(ReferenceReport own) const {
    base::StateBytes said;
    gaussdrift::pass(said, own);
    const auto of_ranks = ranks_.gather(base::to_bytes(said.written()));
    ReferenceReport all;
    for (const base::Bytes& bytes : of_ranks) {
      const std::string told = base::to_text(bytes);
      base::StateBytes heard(told);
      ReferenceReport one;
      gaussdrift::pass(heard, one);
      if (one.untraced > 0 && (all.untraced == 0 || is_before(one.first_untraced, all.first_untraced))) {
        all.first_untraced = one.first_untraced;
        all.trouble = one.trouble;
      }
      all.untraced += one.untraced;
      all.exhausted += one.exhausted;
      all.rates += one.rates;
    }
    return all;
  }

  std::unique_ptr<Reference> own_;
  std::size_t points_;
  base::Communicator& ranks_;
};

}  // namespace

std::unique_ptr<Reference> shared_reference(std::unique_ptr<Reference> own, const Lattice& lattice,
                                            base::Communicator& ranks) {
  return std::make_unique<SharedReference>(std::move(own), lattice, ranks);
}

}  // namespace gaussdrift
