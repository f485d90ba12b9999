// Small scenes of mirrors and panes, in which every object has a colour of its own.
#pragma once

#include "core/scene_description.hpp"

namespace nacre::test {

/// A scene without lights: materials are ambient colours. Camera at (0, 0, 3), looking along -z.
class SpecularScene {
public:
    SpecularScene();
    /// A square of edge 2, turned from facing +z about an axis, then scaled and moved. \return its node
    SceneNode& face(const std::string& name, const SceneSpecular& specular, const Vec3& at, double angle = 0,
                    const Vec3& axis = {0, 1, 0}, const Vec3& scale = Vec3(1));
    SceneNode& ball(const Rgb& color, const Vec3& at, double radius = 0.3);
    SceneNode& square(const Rgb& color, const Vec3& at, double angle = 0, const Vec3& axis = {0, 1, 0},
                      const Vec3& scale = Vec3(1));

    SceneDescription scene;

private:
    SceneNode& add(const std::string& name, int mesh, int material, const Vec3& at, double angle, const Vec3& axis,
                   const Vec3& scale);
    int colored(const Rgb& color);
};

/// Two mirrors that face each other at z = -3 and z = 4, behind the camera; coloured balls and squares between.
SceneDescription hallOfMirrors();

/// A floor and a wall of coloured tiles behind a pane of this index.
SceneDescription paneScene(double ior, bool partial, double angle = 0);

}  // namespace nacre::test
