#include <beltrami/teichmuller/sphere_problem.h>

#include <algorithm>

#include <Eigen/Geometry>

#include <beltrami/differentials/sphere_space.h>
#include <beltrami/operators/distortion.h>
#include <beltrami/sphere/atlas.h>

namespace beltrami {

namespace {

constexpr int kConicalRings = 3;

/// A rotation tied to the landmarks, whatever their order: turned surfaces then have the same atlas.
Eigen::Matrix3d upright(const Positions& landmarks) {
    const Eigen::Vector3d sum = landmarks.colwise().sum().transpose(), first = landmarks.row(0);
    const Eigen::Vector3d pole = (sum.norm() > 0.1 ? sum : first).normalized();
    Eigen::Index front = 0;
    (landmarks - landmarks * pole * pole.transpose()).rowwise().norm().maxCoeff(&front);
    const Eigen::Vector3d ahead = landmarks.row(front), y = pole.cross(ahead).normalized();
    Eigen::Matrix3d rotation;
    rotation << y.cross(pole).transpose(), y.transpose(), pole.transpose();
    return rotation;
}

}  // namespace

SphereProblem::SphereProblem(const Surface& source, const Positions& on_sphere, std::vector<int> landmarks,
                             int cluster_count)
    : source_(source), landmarks_(std::move(landmarks)) {
    const Positions points = on_sphere * upright(on_sphere(landmarks_, Eigen::all)).transpose();
    chart_ = std::make_shared<Chart>(make_atlas(source, atlas::corner_places(source.mesh.faces, points)));
    Singularities singularities;
    for (const int v : landmarks_)
        for (const bool south : {false, true})
            if ((south ? -1 : 1) * points(v, 2) > -0.5)
                singularities.pins.push_back(atlas::place(points.row(v), south));
    SamplePoints means = conical_points(source, *chart_, landmarks_, kConicalRings);
    space_ = std::make_shared<SphereSpace>(source, *chart_, points(landmarks_, Eigen::all), means);
    coefficient_step_.emplace(source, *chart_, singularities, 0.0, cluster_count, std::move(means));
    coefficient_step_->set_space(*space_);
}

HamiltonIteration SphereProblem::settle(SphereMapStep& step, const HamiltonIteration::Options& options) {
    if (!state_.space) {
        const CoefficientStep::Result first = coefficient_step(beltrami_coefficient(step.derivatives()));
        state_ = {space_, first.direction, first.k};
    }
    HamiltonIteration iteration(step, *coefficient_step_, options);
    iteration.run(state_, nullptr);
    state_.acceleration.reset();  // the next run is another problem's
    return iteration;
}

QuadraticDifferential SphereProblem::differential(const Eigen::VectorXcd& coefficients) const {
    std::vector<int> poles = landmarks_;
    std::sort(poles.begin(), poles.end());
    return {space_, chart_, coefficients, std::move(poles), {}};
}

CoefficientStep::Result SphereProblem::coefficient_step(const Eigen::VectorXcd& mu) {
    return coefficient_step_->solve(mu, {});
}

}  // namespace beltrami
