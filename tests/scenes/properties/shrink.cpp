// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "tests/scenes/properties/small_scene.hpp"

namespace tesserae::scenes::properties {
namespace {

using Simpler = std::function<void(SmallScene&)>;

/// Sets a number or vector to something plainer.
template <class T>
Simpler set(std::size_t body, T BodyTable::*member, const T& value) {
    return [=](SmallScene& scene) { scene.tables[body].*member = value; };
}
template <class T>
Simpler set_type(std::size_t body, T BodyType::*member, const T& value) {
    return [=](SmallScene& scene) { scene.tables[body].type.*member = value; };
}
template <class T>
Simpler set_physics(T PhysicsSettings::*member, const T& value) {
    return [=](SmallScene& scene) { scene.physics.*member = value; };
}

/// What may be left out of a scene, what takes away most first.
std::vector<Simpler> changes_of(const SmallScene& scene) {
    std::vector<Simpler> changes;
    for (std::size_t i = 0; i < scene.tables.size(); ++i)
        changes.push_back([i](SmallScene& s) {
            s.tables.erase(s.tables.begin() + static_cast<std::ptrdiff_t>(i));
        });
    for (const int steps : {scene.steps / 2, scene.steps - 1})
        changes.push_back([steps](SmallScene& s) {
            s.steps = steps;
            s.physics.duration = steps / s.physics.steps_per_second;
        });
    const PhysicsSettings usual;
    changes.push_back(set_physics(&PhysicsSettings::gravity, Vec4(Vec4::Zero())));
    changes.push_back(set_physics(&PhysicsSettings::sleeping, false));
    changes.push_back(set_physics(&PhysicsSettings::substeps, usual.substeps));
    for (const int fewer : {1, usual.iterations})
        if (fewer < scene.physics.iterations)
            changes.push_back(set_physics(&PhysicsSettings::iterations, fewer));
    changes.push_back(set_physics(&PhysicsSettings::tolerance, usual.tolerance));
    changes.push_back(set_physics(&PhysicsSettings::integrator, usual.integrator));
    for (std::size_t i = 0; i < scene.tables.size(); ++i) {
        changes.push_back(set_type(i, &BodyType::friction, 0.0));
        changes.push_back(set_type(i, &BodyType::rolling_friction, 0.0));
        changes.push_back(set_type(i, &BodyType::restitution, 0.0));
        changes.push_back(set_type(i, &BodyType::fixed_rotation, false));
        changes.push_back(set_type(i, &BodyType::fixed_position, false));
        if (!is_bounded(scene.tables[i].shape)) continue;
        changes.push_back(set(i, &BodyTable::velocity, Vec4(Vec4::Zero())));
        changes.push_back(set(i, &BodyTable::angular_velocity, Bivector{}));
        changes.push_back(set(i, &BodyTable::rotation, std::vector<Bivector>(1)));
        changes.push_back([i](SmallScene& s) {
            BodyTable& table = s.tables[i];
            table.type.shape = table.shape = Hypersphere{bounding_radius(table.type.shape)};
        });
        for (int axis = 0; axis < 4; ++axis) {
            changes.push_back([i, axis](SmallScene& s) { s.tables[i].position[axis] = 0; });
            changes.push_back([i, axis](SmallScene& s) { s.tables[i].velocity[axis] = 0; });
        }
    }
    return changes;
}

/// The texts leave out how many steps a property is looked at for, but for the duration.
bool is_same(const SmallScene& a, const SmallScene& b) {
    return a.steps == b.steps && text_of(a) == text_of(b);
}

}  // namespace

SmallScene shrunk(SmallScene scene, const std::function<bool(const SmallScene&)>& has_fault) {
    for (bool smaller = true; smaller;) {
        smaller = false;
        const std::vector<Simpler> changes = changes_of(scene);
        for (const Simpler& change : changes) {
            SmallScene changed = scene;
            change(changed);
            if (changed.steps < 1 || changed.tables.empty() || is_same(changed, scene)) continue;
            if (!has_fault(changed)) continue;
            smaller = true;
            const bool is_shorter = changed.tables.size() < scene.tables.size();
            scene = std::move(changed);
            if (is_shorter) break;  // bodies have other numbers now
        }
    }
    return scene;
}

}  // namespace tesserae::scenes::properties
