# SPDX-License-Identifier: Apache-2.0
# The public headers: NAME=FILE is <tesserae/NAME.hpp>. Each belongs to the component that its file
# lies in.
set(TESSERAE_PUBLIC_HEADERS
  vector=core/algebra/vector.hpp
  bivector=core/algebra/bivector.hpp
  rotor=core/algebra/rotor.hpp
  error=core/error.hpp
  shape=core/shape/shape.hpp
  body=core/dynamics/bodies/body.hpp
  joint=core/dynamics/constraints/joint_description.hpp
  settings=core/dynamics/step/settings.hpp
  report=core/dynamics/step/report.hpp
  world=core/world/world.hpp
  threads=parallel/world_threads.hpp
  picture=render/finished_picture.hpp
  scene=scenes/scene_file.hpp
  trajectory=scenes/trajectory_file.hpp)
