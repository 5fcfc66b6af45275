// The one off-screen window of the process: VTK draws into it through OSMesa, without display, GPU or X.
// Everything that would change with another way to a context (EGL, say) is behind these functions.
#pragma once

#include <string>

class vtkRenderWindow;

namespace gaussdrift::render {

/// Makes the window. Empty if it can be had, else the reason and the remedy.
std::string open_window();

/// Before the process ends.
void close_window();

/// The window, empty, in this size. Lives until the process ends; for one thread at a time.
vtkRenderWindow* offscreen_window(int width, int height);

/// Lets another thread draw next.
void release_window();

}  // namespace gaussdrift::render
