//! What is written and read: one file per property, one program.
mod checkpoint_file;
mod common;
mod csv_names;
mod errors_name;
mod files;
mod map_colour_bar;
mod map_shared_pixels;
mod plot_any_range;
mod plot_legend;
mod plot_log_log;
mod polar;
mod resumed_outputs;
mod series_steps;
mod vtk_names;
mod whole_files;
