// The polynomial of a window, from the sums over its samples: any number of terms, one window at a time.
// Stability: inner.
#pragma once
#include <cstddef>
#include <vector>

namespace bandlimit {

/// Calls body(plane, k, l) for all pairs k <= l of `count`, whose planes begin at `first`.
template <class Body>
void each_pair(int first, int count, const Body& body) {
    for (int k = 0, plane = first; k < count; ++k)
        for (int l = k; l < count; ++l, ++plane) body(plane, k, l);
}

/// Which sums there are: planes [0] weights; [1 + i] terms; products of terms (0 0, 0 1, .., 1 1, ..); and for each signal
/// the signal, and its products with the terms.
struct PolynomialShape {
    int guides = 1, signals = 1, order = 1;

    int pairs() const { return order == 1 ? 0 : guides * (guides + 1) / 2; }
    int terms() const { return guides + pairs(); }
    int first_product() const { return 1 + terms(); }
    int first_signal() const { return first_product() + terms() * (terms() + 1) / 2; }
    int planes() const { return first_signal() + signals * (1 + terms()); }
    /// Calls body(term, k, l) for the terms that are products of guides.
    template <class Body>
    void each_guide_pair(const Body& body) const {
        if (order > 1) each_pair(guides, guides, body);
    }
};

class PolynomialFit {
public:
    /// A variance below the share `noise` of its term's mean square counts as none.
    PolynomialFit(const PolynomialShape& shape, double epsilon, double noise);

    /// To the window at column x. Whether it has any weight; if not, the rest is not defined.
    bool solve(const double* const* sums, int x);
    /// The mean of a guide in the window.
    double mean(int guide) const { return means_[static_cast<std::size_t>(guide)]; }
    /// What signal s is, [guides] away from their means.
    double value(int s, const double* away) const;
    /// The constant and coefficients of signal s plus `more`, for guides that are `shift` [guides] more than those of the
    /// sums, as about another offset.
    void coefficients(int s, const double* shift, double more, float* to, std::ptrdiff_t step) const;

private:
    double& at(int i, int j) { return matrix_[static_cast<std::size_t>(i * terms_ + j)]; }
    void gather(const double* const* sums, int x, double weight);
    void centre_pairs();
    void regularise();
    void drop_overflow();
    void factorise();
    void substitute(double* a) const;

    PolynomialShape shape_;
    double epsilon_, share_of_noise_;
    int terms_;
    std::vector<double> means_, matrix_, noise_, inverse_, spread_;  // spread: covariances of guides, by pair
    std::vector<double> signals_, solution_;                         // means; [signals][terms]
};

}  // namespace bandlimit
