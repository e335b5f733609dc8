//! What bodies are made of: one file per property, one program.
mod cell_boundary;
mod convergence;
mod crack_clear;
mod crack_invariance;
mod crack_reference;
mod crack_surface;
mod grid_order;
mod influence;
mod neighbour_search;
mod node_sets;
mod point_cloud;
mod quadrature_tables;
mod quadrature_volume;
mod region_volume;
mod shape_conditioning;
mod symbol_chain;
