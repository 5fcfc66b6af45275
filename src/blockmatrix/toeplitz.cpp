// Toeplitz matrices by the fast Fourier transform of Eigen.
#include <complex>
#include <string>
#include <unsupported/Eigen/FFT>

#include "blockmatrix/block_matrix.hpp"

namespace gaussdrift::blockmatrix {

// M is the upper left corner of the circulant matrix with the column m_0, m_1, ..., m_{N-1}, 0, ..., m_{1-N}, ...,
// m_{-1}, whose product is a convolution: x -> F^-1 (F c . F x).
struct ToeplitzMatrix::Transform {
  std::size_t period = 2;                                         // of the circulant matrix, a power of 2
  std::vector<std::complex<double>> spectrum;                     // F c, half of it
  Eigen::FFT<double> plan{{}, Eigen::FFT<double>::HalfSpectrum};  // with its roots of unity; copied for every product
};

ToeplitzMatrix::ToeplitzMatrix(const Eigen::Ref<const Eigen::VectorXd>& column,
                               const Eigen::Ref<const Eigen::VectorXd>& row)
    : size_(column.size()) {
  if (size_ == 0 || row.size() != size_)
    throw farfield::InvalidArgument(
        "block matrix: a Toeplitz matrix needs a column and a row of equal length, at least 1, and has " +
        std::to_string(size_) + " and " + std::to_string(row.size()));
  if (column[0] != row[0])
    throw farfield::InvalidArgument(
        "block matrix: column and row of a Toeplitz matrix must have the first entry in common");
  const auto transform = std::make_shared<Transform>();
  std::size_t& period = transform->period;
  while (period < 2 * static_cast<std::size_t>(size_) - 1) period *= 2;
  std::vector<double> circulant(period, 0.0);
  for (Eigen::Index k = 0; k < size_; ++k) {
    circulant[static_cast<std::size_t>(k)] = column[k];
    if (k > 0) circulant[period - static_cast<std::size_t>(k)] = row[k];
  }
  transform->plan.fwd(transform->spectrum, circulant);
  transform->plan.inv(circulant, transform->spectrum, static_cast<Eigen::Index>(period));  // makes the other plan
  transform_ = transform;
}

Eigen::VectorXd ToeplitzMatrix::operator*(const Eigen::Ref<const Eigen::VectorXd>& x) const {
  if (x.size() != size_)
    throw farfield::InvalidArgument("block matrix: the vector has " + std::to_string(x.size()) +
                                    " entries, the matrix " + std::to_string(size_) + " columns");
  std::vector<double> padded(transform_->period, 0.0);
  std::copy(x.data(), x.data() + size_, padded.begin());
  Eigen::FFT<double> plan = transform_->plan;
  std::vector<std::complex<double>> spectrum;
  plan.fwd(spectrum, padded);
  for (std::size_t k = 0; k < spectrum.size(); ++k) spectrum[k] *= transform_->spectrum[k];
  plan.inv(padded, spectrum, static_cast<Eigen::Index>(transform_->period));
  return Eigen::Map<const Eigen::VectorXd>(padded.data(), size_);
}

}  // namespace gaussdrift::blockmatrix
