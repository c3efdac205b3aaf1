// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>
#include <btBulletCollisionCommon.h>

#include <vector>

#include "bench/contact_pairs.hpp"

// The same in 3D with Bullet's own function for the pair of shapes, reached the way its dispatcher
// does. What is left out is in Bullet's favour: merging the points into its cache of four.
namespace tesserae::bench {

inline btScalar bullet_size(Random& random) { return static_cast<btScalar>(random_size(random)); }

inline btSphereShape random_shape(Random& random, const btSphereShape*) {
    return btSphereShape(bullet_size(random) / 2);
}
inline btCapsuleShape random_shape(Random& random, const btCapsuleShape*) {
    const btScalar radius = bullet_size(random) / 2;
    return btCapsuleShape(radius, bullet_size(random));
}
inline btBoxShape random_shape(Random& random, const btBoxShape*) {
    const btScalar x = bullet_size(random), y = bullet_size(random), z = bullet_size(random);
    return btBoxShape(btVector3(x, y, z) / 2);
}

template <class BulletShape>
class PairsInBullet {
  public:
    struct Body {
        BulletShape shape;
        btTransform place;
    };
    struct Pair {
        Body a, b;
    };

    PairsInBullet() {
        for (btCollisionObject& object : objects_) object.setCollisionShape(&sample_.shape);
        const btCollisionObjectWrapper a = wrapped(sample_.shape, sample_.place, 0);
        const btCollisionObjectWrapper b = wrapped(sample_.shape, sample_.place, 1);
        algorithm_ = dispatcher_.findAlgorithm(&a, &b, nullptr, BT_CONTACT_POINT_ALGORITHMS);
    }
    ~PairsInBullet() {
        algorithm_->~btCollisionAlgorithm();
        dispatcher_.freeCollisionAlgorithm(algorithm_);
    }
    PairsInBullet(const PairsInBullet&) = delete;
    PairsInBullet& operator=(const PairsInBullet&) = delete;

    Pair random_pair(Random& random) const {
        Pair pair{random_body(random), random_body(random)};
        btVector3 low, high_a, high_b;
        pair.a.shape.getAabb(pair.a.place, low, high_a);
        pair.b.shape.getAabb(pair.b.place, low, high_b);
        for (int i = 0; i < 3; ++i) {
            const double reach = static_cast<double>(high_a[i] + high_b[i]);
            pair.b.place.getOrigin()[i] = static_cast<btScalar>(uniform(random, -reach, reach));
        }
        return pair;
    }

    Pair resting_pair(Random& random) const {
        Pair pair{random_body(random), random_body(random)};
        btVector3 low, half_a, half_b;
        pair.a.shape.getAabb(btTransform::getIdentity(), low, half_a);
        pair.b.shape.getAabb(btTransform::getIdentity(), low, half_b);
        const auto within = [&](btScalar half) {
            return static_cast<btScalar>(uniform(random, -half, half));
        };
        const btScalar up = half_a.y() + half_b.y() - static_cast<btScalar>(kRestingDepth);
        const btVector3 offset(within(half_a.x()), up, within(half_a.z()));
        const btQuaternion turn(btVector3(0, 1, 0), within(3));
        pair.b.place = pair.a.place * btTransform(turn, offset);
        return pair;
    }

    void find(const Pair& pair) {
        const btCollisionObjectWrapper a = wrapped(pair.a.shape, pair.a.place, 0);
        const btCollisionObjectWrapper b = wrapped(pair.b.shape, pair.b.place, 1);
        points_.list.clear();
        points_.setBody0Wrap(&a);
        points_.setBody1Wrap(&b);
        algorithm_->processCollision(&a, &b, information_, &points_);
    }
    std::size_t points() const { return points_.list.size(); }
    /// Bullet also reports points a little apart.
    bool touching() const {
        for (const Point& point : points_.list)
            if (point.depth <= 0) return true;
        return false;
    }

  private:
    struct Point {
        btVector3 normal, point;
        btScalar depth;
    };
    struct Points : btManifoldResult {
        std::vector<Point> list;
        void addContactPoint(const btVector3& normal, const btVector3& point,
                             btScalar depth) override {
            list.push_back({normal, point, depth});
        }
    };
    static Body first_body() {
        Random random;
        return random_body(random);
    }
    static Body random_body(Random& random) {
        const Vec4 q = random_normals(random).normalized();
        const auto component = [&](int i) { return static_cast<btScalar>(q[i]); };
        const btQuaternion turn(component(0), component(1), component(2), component(3));
        return {random_shape(random, static_cast<const BulletShape*>(nullptr)),
                btTransform(turn, btVector3(0, 0, 0))};
    }
    btCollisionObjectWrapper wrapped(const BulletShape& shape, const btTransform& place,
                                     int object) const {
        return {nullptr, &shape, &objects_[object], place, -1, -1};
    }

    // What the algorithm is made with; a call brings its own.
    Body sample_ = first_body();
    btCollisionObject objects_[2];
    btDefaultCollisionConfiguration configuration_;
    btCollisionDispatcher dispatcher_{&configuration_};
    btDispatcherInfo information_;
    btCollisionAlgorithm* algorithm_ = nullptr;
    Points points_;
};

}  // namespace tesserae::bench
