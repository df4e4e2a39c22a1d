export default { base: './', build: { target: 'es2022', assetsInlineLimit: 0, chunkSizeWarningLimit: 1500 } };
