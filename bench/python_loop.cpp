// SPDX-License-Identifier: Apache-2.0
// The loop of bench/python_loop.py in C++: steps a scene's world, and prints the time that it took.
//   python_loop SCENE STEPS THREADS OUTPUT    OUTPUT gets the world's bytes at the end
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>

#include "parallel/world_threads.hpp"
#include "scenes/scene_file.hpp"

int main(int argc, char** argv) {
    if (argc != 5) return 2;
    tesserae::World world =
        tesserae::Scene::read(argv[1]).world(tesserae::threads(std::atoi(argv[3])));
    const int steps = std::atoi(argv[2]);
    const auto begin = std::chrono::steady_clock::now();
    for (int i = 0; i < steps; ++i) world.step();
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    std::printf("%.6f\n", took.count());
    std::ofstream(argv[4], std::ios::binary) << world.save();
}
