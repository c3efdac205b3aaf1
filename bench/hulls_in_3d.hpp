// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkEpaPenetrationDepthSolver.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkPairDetector.h>
#include <BulletCollision/NarrowPhaseCollision/btPointCollector.h>
#include <BulletCollision/NarrowPhaseCollision/btVoronoiSimplexSolver.h>
#include <btBulletCollisionCommon.h>
#include <ccd/ccd.h>

#include <Eigen/Geometry>
#include <map>
#include <memory>
#include <numbers>
#include <vector>

#include "bench/convex_pairs.hpp"
#include "core/convex/linear_forms.hpp"

// Cubes and icosahedra in w = 0: for tesserae the product with a segment along w, for Bullet and
// libccd the hulls themselves. Apart the distance is that of the hulls; the overlap is too, for
// along w they overlap by more.
namespace tesserae::bench {

/// Half of the segment along w [m].
constexpr double kHalfThickness = 0.5;

/// Of parallel vectors the first stays, of zeros none.
inline void keep_lines(std::vector<Eigen::Vector3d>& all) {
    std::vector<Eigen::Vector3d> lines;
    for (const Eigen::Vector3d& v : all) {
        if (v.norm() < 1e-9) continue;
        const Eigen::Vector3d unit = v.normalized();
        if (std::none_of(lines.begin(), lines.end(), [&](const Eigen::Vector3d& line) {
                return line.cross(unit).norm() < 1e-9;
            }))
            lines.push_back(unit);
    }
    all = lines;
}

/// A hull in w = 0 with its farthest points, which libccd is given too.
struct FlatHull {
    std::vector<Vec4> vertices;
    LinearForms corners;
    std::vector<Eigen::Vector3d> edges, normals;  ///< their directions; of edges' planes more

    /// @param points   of a regular polyhedron: its edges are the shortest ways between them
    explicit FlatHull(std::vector<Vec4> points) : vertices(std::move(points)) {
        for (const Vec4& p : vertices) corners.add(p, 0);
        const auto from_first = [&](std::size_t i) { return (vertices[i] - vertices[0]).norm(); };
        double shortest = from_first(1);
        for (std::size_t i = 2; i < vertices.size(); ++i)
            shortest = std::min(shortest, from_first(i));
        for (const Vec4& p : vertices) {
            std::vector<Eigen::Vector3d> there;
            for (const Vec4& q : vertices) {
                const Eigen::Vector3d edge = (q - p).head<3>();
                if (edge.norm() > 0 && edge.norm() < 1.01 * shortest) there.push_back(edge);
            }
            for (const Eigen::Vector3d& e : there) {
                edges.push_back(e);
                for (const Eigen::Vector3d& f : there) normals.push_back(e.cross(f));
            }
        }
        keep_lines(edges), keep_lines(normals);
    }

    const Vec4& farthest(const Vec4& direction) const {
        return vertices[corners.largest_at(direction).number];
    }
};

inline std::vector<Vec4> cube_vertices(double radius) {
    std::vector<Vec4> points;
    const double half = radius / std::sqrt(3.0);
    for (unsigned corner = 0; corner < 8; ++corner) {
        Vec4 p(half, half, half, 0);
        for (int i = 0; i < 3; ++i)
            if (corner >> i & 1u) p[i] = -half;
        points.push_back(p);
    }
    return points;
}
inline std::vector<Vec4> icosahedron_vertices(double radius) {
    std::vector<Vec4> points;
    for (int axis = 0; axis < 3; ++axis)
        for (const double one : {-1.0, 1.0})
            for (const double golden : {-std::numbers::phi, std::numbers::phi}) {
                Vec4 p = Vec4::Zero();
                p[axis] = one, p[(axis + 1) % 3] = golden;
                points.push_back(radius * p.normalized());
            }
    return points;
}

/// The three forms of every solid of a set, by its shape in four dimensions.
struct HullForms {
    std::unique_ptr<FlatHull> flat;
    std::unique_ptr<btConvexHullShape> bullet;
};
struct Hulls {
    std::vector<ConvexSolid> solids;
    std::map<const Shape*, HullForms> forms;

    /// @param vertices_of   a hull's vertices of a circumradius [m], of 0.35 to 0.65 m
    Hulls(std::vector<Vec4> (*vertices_of)(double), int count) {
        for (int i = 0; i < count; ++i) {
            const double radius = 0.35 + 0.3 * (i + 0.5) / count;
            const std::vector<Vec4> points = vertices_of(radius);
            Polychoron prism;
            prism.regular = RegularPolychoron::kNone;
            HullForms form{std::make_unique<FlatHull>(points),
                           std::make_unique<btConvexHullShape>()};
            for (const Vec4& p : points) {
                for (const double side : {-1.0, 1.0})
                    prism.vertices.push_back(p + side * kHalfThickness * Vec4::UnitW());
                form.bullet->addPoint(btVector3(p[0], p[1], p[2]), false);
            }
            form.bullet->setMargin(0);
            form.bullet->recalcLocalAabb();
            form.bullet->initializePolyhedralFeatures();
            solids.push_back(solid_of(prism));
            solids.back().radius = radius;
            forms[solids.back().shape.get()] = std::move(form);
        }
    }
};

/// A body as the other engines have it, made before anything is timed.
struct PlacedHull {
    const FlatHull* flat;
    const btConvexHullShape* bullet;
    Mat4 turn;
    Vec4 position;
    btTransform place;

    PlacedHull(const Hulls& hulls, const ConvexSolid& solid)
        : flat(hulls.forms.at(solid.shape.get()).flat.get()),
          bullet(hulls.forms.at(solid.shape.get()).bullet.get()),
          turn(to_matrix(solid.rotor)),
          position(solid.position) {
        const Mat4& m = turn;
        place.setBasis(btMatrix3x3(m(0, 0), m(0, 1), m(0, 2), m(1, 0), m(1, 1), m(1, 2), m(2, 0),
                                   m(2, 1), m(2, 2)));
        place.setOrigin(btVector3(position[0], position[1], position[2]));
    }
    Vec4 operator()(const Vec4& direction) const {
        return position + turn * flat->farthest(turn.transpose() * direction);
    }
};
struct HullPair {
    PlacedHull a, b;
    double radii;  ///< of both
    double size() const { return radii; }
};

/// In overlap the distance: the greatest of all directions that can have it, each of them tried.
inline double distance_by_all_axes(const HullPair& pair) {
    double best = -std::numeric_limits<double>::infinity();
    const auto attempt = [&](const Eigen::Vector3d& axis) {
        if (axis.norm() < 1e-9) return;  // of parallel edges
        for (const double side : {-1.0, 1.0}) {
            Vec4 n = Vec4::Zero();
            n.head<3>() = side * axis.normalized();
            best = std::max(best, n.dot(pair.b(-n)) - n.dot(pair.a(n)));
        }
    };
    const Eigen::Matrix3d turn_a = pair.a.turn.topLeftCorner<3, 3>();
    const Eigen::Matrix3d turn_b = pair.b.turn.topLeftCorner<3, 3>();
    for (const Eigen::Vector3d& n : pair.a.flat->normals) attempt(turn_a * n);
    for (const Eigen::Vector3d& n : pair.b.flat->normals) attempt(turn_b * n);
    for (const Eigen::Vector3d& e : pair.a.flat->edges)
        for (const Eigen::Vector3d& f : pair.b.flat->edges) attempt((turn_a * e).cross(turn_b * f));
    return best;
}

/// The hulls without thickness by tesserae: only while they are apart.
inline double flat_distance(const HullPair& pair) {
    return separation_of(pair.a, pair.b, stable_normalized(pair.b.position - pair.a.position),
                         pair.radii)
        .distance;
}

/// Bullet's convex-convex with margins of 0. It begins along y, whatever it is told.
class HullsInBullet {
  public:
    HullsInBullet() {
        for (btCollisionObject& object : objects_) object.setCollisionShape(&sample_);
        const btTransform place = btTransform::getIdentity();
        const btCollisionObjectWrapper a(nullptr, &sample_, &objects_[0], place, -1, -1);
        const btCollisionObjectWrapper b(nullptr, &sample_, &objects_[1], place, -1, -1);
        algorithm_ = dispatcher_.findAlgorithm(&a, &b, nullptr, BT_CONTACT_POINT_ALGORITHMS);
    }
    ~HullsInBullet() {
        algorithm_->~btCollisionAlgorithm();
        dispatcher_.freeCollisionAlgorithm(algorithm_);
    }
    HullsInBullet(const HullsInBullet&) = delete;
    HullsInBullet& operator=(const HullsInBullet&) = delete;

    /// GJK, and where they overlap Bullet's expanding polytope.
    double distance(const HullPair& pair) {
        btGjkPairDetector detector(pair.a.bullet, pair.b.bullet, &simplex_, &overlap_);
        btGjkPairDetector::ClosestPointInput input;
        input.m_transformA = pair.a.place, input.m_transformB = pair.b.place;
        btPointCollector found;
        detector.getClosestPoints(input, found, nullptr);
        return found.m_distance;
    }
    /// Its algorithm for the pair: the distance, and faces clipped to each other.
    /// @param separating_axes   by these instead of GJK
    std::size_t contacts(const HullPair& pair, bool separating_axes) {
        const btCollisionObjectWrapper a(nullptr, pair.a.bullet, &objects_[0], pair.a.place, -1,
                                         -1);
        const btCollisionObjectWrapper b(nullptr, pair.b.bullet, &objects_[1], pair.b.place, -1,
                                         -1);
        information_.m_enableSatConvex = separating_axes;
        points_.count = 0;
        points_.setBody0Wrap(&a);
        points_.setBody1Wrap(&b);
        algorithm_->processCollision(&a, &b, information_, &points_);
        return points_.count;
    }

  private:
    struct Points : btManifoldResult {
        std::size_t count = 0;
        void addContactPoint(const btVector3&, const btVector3&, btScalar) override { ++count; }
    };

    btConvexHullShape sample_;
    btCollisionObject objects_[2];
    btDefaultCollisionConfiguration configuration_;
    btCollisionDispatcher dispatcher_{&configuration_};
    btDispatcherInfo information_;
    btCollisionAlgorithm* algorithm_ = nullptr;
    btVoronoiSimplexSolver simplex_;
    btGjkEpaPenetrationDepthSolver overlap_;
    Points points_;
};

/// libccd with our farthest points and our first direction. It knows no distances: apart it says no
/// more than that.
class HullsInCcd {
  public:
    /// @param tolerance   of the polytope: compared with a difference of squares [m^2]
    explicit HullsInCcd(double tolerance) {
        CCD_INIT(&settings_);
        settings_.epa_tolerance = tolerance;
        settings_.support1 = settings_.support2 = support;
        settings_.center1 = settings_.center2 = centre;
        settings_.first_dir = first_direction;
        settings_.max_iterations = 500;
    }
    /// Infinite if apart. GJK and an expanding polytope.
    double overlap(const HullPair& pair) const { return overlap_by(ccdGJKPenetration, pair); }
    /// Infinite if apart. Minkowski portal refinement: along its own direction, not the least.
    double overlap_by_portals(const HullPair& pair) const {
        return overlap_by(ccdMPRPenetration, pair);
    }

  private:
    template <class F>
    double overlap_by(F* function, const HullPair& pair) const {
        ccd_real_t depth = 0;
        ccd_vec3_t direction, place;
        const int failed = function(&pair.a, &pair.b, &settings_, &depth, &direction, &place);
        return failed ? std::numeric_limits<double>::infinity() : depth;
    }
    static void put(const Vec4& p, ccd_vec3_t* out) { ccdVec3Set(out, p[0], p[1], p[2]); }
    static void support(const void* hull, const ccd_vec3_t* d, ccd_vec3_t* out) {
        put((*static_cast<const PlacedHull*>(hull))(Vec4(d->v[0], d->v[1], d->v[2], 0)), out);
    }
    static void centre(const void* hull, ccd_vec3_t* out) {
        put(static_cast<const PlacedHull*>(hull)->position, out);
    }
    static void first_direction(const void* a, const void* b, ccd_vec3_t* out) {
        put(static_cast<const PlacedHull*>(b)->position -
                static_cast<const PlacedHull*>(a)->position,
            out);
    }

    ccd_t settings_;
};

}  // namespace tesserae::bench
