# SPDX-License-Identifier: Apache-2.0
# What is public of it is in the stub of the package.
