#include "bandlimit/filter/polynomial_fit.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "bandlimit/filter/window_rows.h"

namespace bandlimit {

PolynomialFit::PolynomialFit(const PolynomialShape& shape, double epsilon, double noise)
    : shape_(shape),
      epsilon_(std::min(epsilon, 1e150)),  // its square is finite
      share_of_noise_(noise),
      terms_(shape.terms()) {
    const auto terms = static_cast<std::size_t>(terms_), signals = static_cast<std::size_t>(shape.signals);
    means_.resize(terms), noise_.resize(terms), inverse_.resize(terms);
    matrix_.resize(terms * terms);
    spread_.resize(static_cast<std::size_t>(shape.pairs()));
    signals_.resize(signals), solution_.resize(signals * terms);
}

bool PolynomialFit::solve(const double* const* sums, int x) {
    const double weight = sums[0][x];
    if (!(weight > 0)) return false;
    gather(sums, x, weight);
    centre_pairs();
    regularise();
    drop_overflow();
    factorise();
    for (int s = 0; s < shape_.signals; ++s) substitute(&solution_[static_cast<std::size_t>(s * terms_)]);
    return true;
}

/// Means and covariances; noise_ is what rounding makes of a variance.
void PolynomialFit::gather(const double* const* sums, int x, double weight) {
    const auto mean = [&](int plane) { return sums[plane][x] / weight; };
    for (int i = 0; i < terms_; ++i) means_[static_cast<std::size_t>(i)] = mean(1 + i);
    each_pair(shape_.first_product(), terms_, [&](int plane, int i, int j) {
        const double square = mean(plane);
        at(i, j) = at(j, i) = square - means_[static_cast<std::size_t>(i)] * means_[static_cast<std::size_t>(j)];
        if (i == j) at(i, i) = std::max(0.0, at(i, i)), noise_[static_cast<std::size_t>(i)] = square * share_of_noise_;
    });
    for (int s = 0, plane = shape_.first_signal(); s < shape_.signals; ++s) {
        const double signal = signals_[static_cast<std::size_t>(s)] = mean(plane++);
        for (int i = 0; i < terms_; ++i, ++plane)
            solution_[static_cast<std::size_t>(s * terms_ + i)] =
                mean(plane) - signal * means_[static_cast<std::size_t>(i)];
    }
}

/// Pairs become products of guides less their means: u v - mean(u) v - mean(v) u, and a constant.
void PolynomialFit::centre_pairs() {
    shape_.each_guide_pair([&](int pair, int k, int l) {
        const double mk = mean(k), ml = mean(l);
        for (int j = 0; j < terms_; ++j) at(pair, j) -= mk * at(l, j) + ml * at(k, j);
        for (int s = 0; s < shape_.signals; ++s) {
            double* const c = &solution_[static_cast<std::size_t>(s * terms_)];
            c[pair] -= mk * c[l] + ml * c[k];
        }
    });
    shape_.each_guide_pair([&](int pair, int k, int l) {
        for (int i = 0; i < terms_; ++i) at(i, pair) -= mean(k) * at(i, l) + mean(l) * at(i, k);
        spread_[static_cast<std::size_t>(pair - shape_.guides)] = at(k, l);
    });
}

void PolynomialFit::regularise() {
    for (int i = 0; i < terms_; ++i) noise_[static_cast<std::size_t>(i)] += dependence_noise * at(i, i);
    shape_.each_guide_pair([&](int pair, int k, int l) {
        const double twice = k == l ? 2 : 1;
        at(pair, pair) =
            std::max(0.0, at(pair, pair)) + twice * ((at(k, k) + at(l, l)) * epsilon_ + epsilon_ * epsilon_);
    });
    for (int k = 0; k < shape_.guides; ++k) at(k, k) += epsilon_;
}

/// Terms whose sums are not finite are as good as missing.
void PolynomialFit::drop_overflow() {
    for (int i = shape_.guides; i < terms_; ++i) {
        bool is_finite = true;
        for (int j = 0; j < terms_; ++j)
            is_finite = is_finite && !std::isnan(at(i, j)) && (i == j || std::isfinite(at(i, j)));
        for (int s = 0; s < shape_.signals; ++s)
            is_finite = is_finite && std::isfinite(solution_[static_cast<std::size_t>(s * terms_ + i)]);
        if (is_finite) continue;
        for (int j = 0; j < terms_; ++j) at(i, j) = at(j, i) = 0;
        for (int s = 0; s < shape_.signals; ++s) solution_[static_cast<std::size_t>(s * terms_ + i)] = 0;
        spread_[static_cast<std::size_t>(i - shape_.guides)] = 0;
    }
}

/// The matrix becomes L below its diagonal, of L D L^T; inverse_ is that of D, 0 for what is left out.
void PolynomialFit::factorise() {
    for (int k = 0; k < terms_; ++k) {
        const double pivot = at(k, k);
        const double inverse = inverse_[static_cast<std::size_t>(k)] =
            pivot > noise_[static_cast<std::size_t>(k)] ? 1 / pivot : 0;
        for (int i = terms_ - 1; i > k; --i) {
            const double l = at(i, k) * inverse;
            for (int j = k + 1; j <= i; ++j) at(i, j) -= l * at(j, k);
            at(i, k) = l;
        }
    }
}

void PolynomialFit::substitute(double* a) const {
    const auto l = [&](int i, int k) { return matrix_[static_cast<std::size_t>(i * terms_ + k)]; };
    for (int k = 0; k < terms_; ++k)
        for (int i = k + 1; i < terms_; ++i) a[i] -= l(i, k) * a[k];
    for (int k = terms_ - 1; k >= 0; --k) {
        a[k] *= inverse_[static_cast<std::size_t>(k)];
        for (int i = k + 1; i < terms_; ++i) a[k] -= l(i, k) * a[i];
    }
}

double PolynomialFit::value(int s, const double* away) const {
    const double* const a = &solution_[static_cast<std::size_t>(s * terms_)];
    double value = signals_[static_cast<std::size_t>(s)];
    for (int k = 0; k < shape_.guides; ++k) value += a[k] * away[k];
    shape_.each_guide_pair([&](int pair, int k, int l) {
        value += a[pair] * (away[k] * away[l] - spread_[static_cast<std::size_t>(pair - shape_.guides)]);
    });
    return value;
}

void PolynomialFit::coefficients(int s, const double* shift, double more, float* to, std::ptrdiff_t step) const {
    const double* const a = &solution_[static_cast<std::size_t>(s * terms_)];
    std::vector<double> slopes(a, a + shape_.guides);
    const auto centre = [&](int k) { return mean(k) + shift[k]; };
    double constant = signals_[static_cast<std::size_t>(s)] + more;
    for (int k = 0; k < shape_.guides; ++k) constant -= a[k] * centre(k);
    shape_.each_guide_pair([&](int pair, int k, int l) {
        constant += a[pair] * (centre(k) * centre(l) - spread_[static_cast<std::size_t>(pair - shape_.guides)]);
        slopes[static_cast<std::size_t>(k)] -= a[pair] * centre(l);
        slopes[static_cast<std::size_t>(l)] -= a[pair] * centre(k);
    });
    to[0] = static_cast<float>(constant);
    for (int i = 0; i < terms_; ++i)
        to[(1 + i) * step] = static_cast<float>(i < shape_.guides ? slopes[static_cast<std::size_t>(i)] : a[i]);
}

}  // namespace bandlimit
