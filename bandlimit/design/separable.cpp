#include "bandlimit/design/separable.h"

#include <ceres/gradient_problem.h>
#include <ceres/gradient_problem_solver.h>
#include <ceres/jet.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "bandlimit/core/error.h"

namespace bandlimit {
namespace {

constexpr int rounds = 15;

using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// What one weight adds to the sum that the mean is of, with |w| as sqrt(w^2 + smoothing^2).
template <class T>
T point_loss(const T& weight, double shape, const SeparableLoss& loss, double smoothing) {
    using std::sqrt;
    const T difference = weight - shape, magnitude = sqrt(weight * weight + smoothing * smoothing);
    T sum = difference * difference + loss.non_negative * 0.5 * (magnitude - weight);
    if (shape == 0) sum += loss.keep_zeros * magnitude;
    return sum;
}

/// The smoothed loss of all columns, then all rows: parameters [height][terms], [width][terms].
class SmoothLoss final : public ceres::FirstOrderFunction {
public:
    SmoothLoss(const WeightGrid& shape, Eigen::Index terms, const SeparableLoss& loss, double smoothing)
        : shape_(shape), terms_(terms), loss_(loss), smoothing_(smoothing) {}

    int NumParameters() const override { return (shape_.width + shape_.height) * static_cast<int>(terms_); }

    bool Evaluate(const double* parameters, double* cost, double* gradient) const override {
        const Eigen::Index split = shape_.height * terms_;
        const Eigen::Map<const Matrix> columns(parameters, shape_.height, terms_);
        const Eigen::Map<const Matrix> rows(parameters + split, shape_.width, terms_);
        // First the weights, then in their place the derivative by each.
        Matrix weights = columns * rows.transpose();
        const double share = 1 / static_cast<double>(weights.size());
        double sum = 0;
        for (Eigen::Index i = 0; i < weights.size(); ++i) {
            using Jet = ceres::Jet<double, 1>;
            const Jet point =
                point_loss(Jet(weights.data()[i], 0), shape_.weights[static_cast<std::size_t>(i)], loss_, smoothing_);
            sum += point.a;
            weights.data()[i] = point.v[0] * share;
        }
        *cost = sum * share;
        if (gradient != nullptr) {
            Eigen::Map<Matrix>(gradient, shape_.height, terms_).noalias() = weights * rows;
            Eigen::Map<Matrix>(gradient + split, shape_.width, terms_).noalias() = weights.transpose() * columns;
        }
        return true;
    }

private:
    const WeightGrid& shape_;
    Eigen::Index terms_;
    SeparableLoss loss_;
    double smoothing_;
};

/// The parameters of SmoothLoss; `use` takes a parameter and the weight of the terms that it stands for.
template <class AnyTerms, class Use>
void for_each_parameter(AnyTerms& terms, std::vector<double>& parameters, Use use) {
    std::size_t next = 0;
    for (std::size_t y = 0; y < terms[0].column.size(); ++y)
        for (auto& term : terms) use(parameters[next++], term.column[y]);
    for (std::size_t x = 0; x < terms[0].row.size(); ++x)
        for (auto& term : terms) use(parameters[next++], term.row[x]);
}

/// One round of L-BFGS; returns its iterations.
int minimise(const WeightGrid& shape, std::size_t terms, const SeparableLoss& loss, double smoothing,
             std::vector<double>& parameters) {
    const ceres::GradientProblem problem(
        new SmoothLoss(shape, static_cast<Eigen::Index>(terms), loss, smoothing));  // which the problem deletes
    ceres::GradientProblemSolver::Options options;
    options.line_search_direction_type = ceres::LBFGS;
    options.max_num_iterations = 500;
    options.function_tolerance = 1e-9;
    options.gradient_tolerance = 1e-12;
    options.logging_type = ceres::SILENT;
    ceres::GradientProblemSolver::Summary summary;
    ceres::Solve(options, problem, parameters.data(), &summary);
    return static_cast<int>(summary.iterations.size());
}

void check(const WeightGrid& shape, const WeightGrid& weights, const SeparableLoss& loss) {
    if (shape.width != weights.width || shape.height != weights.height || shape.weights.empty())
        fail("separable_loss: weights of ", weights.width, " x ", weights.height, " for a shape of ", shape.width,
             " x ", shape.height, "; pass one size of at least 1 x 1");
    for (const double factor : {loss.non_negative, loss.keep_zeros})
        if (!(factor >= 0 && std::isfinite(factor)))
            fail("separable_loss: a factor of ", factor, "; pass 0 or more (0.5 and 0.3 are usual)");
}

}  // namespace

double separable_loss(const WeightGrid& shape, const WeightGrid& weights, const SeparableLoss& loss) {
    check(shape, weights, loss);
    double sum = 0;
    for (std::size_t i = 0; i < shape.weights.size(); ++i)
        sum += point_loss(weights.weights[i], shape.weights[i], loss, 0);
    return sum / static_cast<double>(shape.weights.size());
}

SeparableFit optimise_separable(const WeightGrid& shape, const Terms& start, const SeparableLoss& loss,
                                const std::function<void(double done)>& progress) {
    SeparableFit fit{start, separable_loss(shape, expanded(start), loss)};
    fit.start_loss = fit.loss;
    if (!std::isfinite(fit.loss)) fail("optimise_separable: weights or shape are not finite; pass finite ones");

    double peak = 0;
    for (const double w : shape.weights) peak = std::max(peak, std::abs(w));
    Terms terms = start;
    std::vector<double> parameters((start[0].column.size() + start[0].row.size()) * start.size());
    for_each_parameter(start, parameters, [](double& parameter, double weight) { parameter = weight; });
    // Of a shape that is 0 the best weights are 0, which no smoothing in parts of its peak leads to.
    for (int round = 0; round < rounds && peak > 0; ++round) {
        fit.iterations += minimise(shape, start.size(), loss, std::ldexp(0.3 * peak, -round), parameters);
        for_each_parameter(terms, parameters, [](double parameter, double& weight) { weight = parameter; });
        const double reached = separable_loss(shape, expanded(terms), loss);
        if (reached < fit.loss) {
            fit.loss = reached;
            fit.terms = terms;
        }
        if (progress) progress((round + 1.0) / rounds);
    }
    return fit;
}

}  // namespace bandlimit
