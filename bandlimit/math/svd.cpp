#include "bandlimit/math/svd.h"

#include <Eigen/SVD>
#include <cmath>

#include "bandlimit/core/error.h"

namespace bandlimit {

Svd svd(std::span<const double> matrix, int rows, int columns) {
    if (rows < 1 || columns < 1 || matrix.size() != static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns))
        fail("svd: ", matrix.size(), " entries for ", rows, " x ", columns, "; pass rows * columns >= 1 of them");
    for (const double v : matrix)
        if (!std::isfinite(v)) fail("svd: an entry is ", v, "; pass finite ones");
    using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    const Eigen::Map<const Matrix> m(matrix.data(), rows, columns);
    const Eigen::BDCSVD<Eigen::MatrixXd> found(m, Eigen::ComputeThinU | Eigen::ComputeThinV);
    Svd result;
    for (Eigen::Index k = 0; k < found.singularValues().size(); ++k) {
        Eigen::Index largest = 0;
        found.matrixU().col(k).cwiseAbs().maxCoeff(&largest);
        const double sign = found.matrixU()(largest, k) < 0 ? -1 : 1;
        const Eigen::VectorXd u = sign * found.matrixU().col(k), v = sign * found.matrixV().col(k);
        result.values.push_back(found.singularValues()(k));
        result.left.emplace_back(u.begin(), u.end());
        result.right.emplace_back(v.begin(), v.end());
    }
    return result;
}

}  // namespace bandlimit
