% nothing
(no block follows)
