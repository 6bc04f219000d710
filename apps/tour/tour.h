// The parts of the tour. Each adds sections to the page and writes its pictures beside it.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "apps/page/page.h"
#include "apps/page/plot.h"
#include "bandlimit/core/image.h"
#include "bandlimit/core/parallel.h"

namespace bandlimit::app {

struct Tour {
    std::filesystem::path directory;
    Parallel parallel;
    Page page;

    std::string path(const std::string& file) const { return (directory / file).string(); }
    /// Draws panels side by side into `file` and returns its name.
    std::string plot(const std::string& file, const std::vector<Panel>& panels, int width, int height) const {
        draw(panels, path(file), width, height);
        return file;
    }
};

void tour_lanczos(Tour& tour);        ///< Lanczos in two dimensions
void tour_grids(Tour& tour);          ///< down- and upsampling, and where the samples lie
void tour_splines(Tour& tour);        ///< linear, quadratic and cubic interpolation
void tour_images(Tour& tour);         ///< zone plate, kernels of auto, star, photograph
void tour_mips(Tour& tour);           ///< mip maps: light, coverage, normals, motion
void tour_audit(Tour& tour);          ///< what other resizers do
void tour_design(Tour& tour);         ///< designed filters: few reads, low rank, phasors, bokeh
void tour_supersampling(Tour& tour);  ///< aliasing, patterns of samples, half of the samples
void tour_temporal(Tour& tour);       ///< accumulation over time, at 1x and 2x
void tour_raster(Tour& tour);         ///< prefiltered points, lines and discs, seams
void tour_gradients(Tour& tour);      ///< gradients and structure tensors

}  // namespace bandlimit::app
