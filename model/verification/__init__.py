"""Problems with known answers, solved with the same mesh, kernels and Newton's method as the actuator."""
